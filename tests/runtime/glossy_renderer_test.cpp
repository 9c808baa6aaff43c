// Glossy transfer as it is drawn.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gl/context.h"
#include "runtime/cpu_pixels.h"
#include "runtime/glossy_models.h"
#include "runtime/pictures.h"

namespace prt::runtime {
namespace {

/// Radiance of about 1, so that 1/255 is a step of an 8-bit picture.
gltf::PrecomputedTransfer dimmed(gltf::PrecomputedTransfer transfer) {
  for (float& value : transfer.encoding.means) value *= 0.1f;
  for (float& value : transfer.encoding.bases) value *= 0.1f;
  return transfer;
}

class GlossyOnEveryApi : public testing::TestWithParam<gl::Api> {
 protected:
  gl::HeadlessContext context_{{.api = GetParam()}};
  Renderer renderer_;

  void load(const Model& model, const sh::Light& light, const ExitOptions& options = {}) {
    renderer_.set_model(model, options);
    renderer_.set_lighting(lighting_from(light));
  }
  image::Image render(const Model& model, Draw draw, int samples = 1, Sums sums = Sums::kept) {
    View view = view_of(model);
    view.draw = draw;
    view.sums = sums;
    return renderer_.render(view, kWidth, kHeight, samples);
  }
};
INSTANTIATE_TEST_SUITE_P(Renderer, GlossyOnEveryApi,
                         testing::Values(gl::Api::core_3_3, gl::Api::es_3_0));

TEST_P(GlossyOnEveryApi, EveryWayOfDrawingGivesTheSamePixels) {
  const mesh::Scene scene = scene_of({with_random_tangents(torus(60, 30))});
  const std::size_t vertices = scene.vertex_count();
  const sh::Light light = test_light(4);
  for (const auto& transfer :
       {with_superclusters(random_transfer(vertices, 4, 1, 40, 5, 9), 1000),
        with_superclusters(random_adaptive_transfer(vertices, 4, 3, 40, 4, 24), 6)}) {
    const Model model = make_model(scene, dimmed(transfer), {});
    load(model, light, {.passes = Passes::one});
    EXPECT_EQ(renderer_.pass_count(), 1);
    const image::Image expected = render(model, Draw::single);
    EXPECT_LT(largest_difference(expected, render(model, Draw::clusters)), 1 / 255.0f);
    EXPECT_LT(largest_difference(render(model, Draw::single, 4), render(model, Draw::clusters, 4)),
              1 / 255.0f);
    EXPECT_LT(largest_difference(expected, render(model, Draw::single, 1, Sums::every_frame)),
              1e-4f);
    load(model, light, {.passes = Passes::per_channel});
    EXPECT_EQ(renderer_.pass_count(), 3);
    for (const Sums sums : {Sums::kept, Sums::every_frame})
      EXPECT_LT(largest_difference(expected, render(model, Draw::single, 1, sums)), 1e-4f);
    EXPECT_LT(largest_difference(expected, render(model, Draw::clusters)), 1 / 255.0f);
  }
}

TEST_P(GlossyOnEveryApi, PixelsAgreeWithTheCpuTwin) {
  const mesh::Scene scene = scene_of({with_random_tangents(torus(40, 20))});
  // Random matrices: neighbours have nothing in common, and the highest bands are as strong as the
  // others.
  for (const int row_count : {9, 24}) {
    const auto transfer = dimmed(with_superclusters(
        random_adaptive_transfer(scene.vertex_count(), 3, 3, 50, 6, row_count), 9));
    const Model model = make_model(scene, transfer, decompressed(transfer));
    const sh::Light light = test_light(3);
    for (const ExitOptions& options :
         {ExitOptions{Passes::one, ViewBasis::polynomial}, {Passes::per_channel, ViewBasis::map}}) {
      load(model, light, options);
      for (const Draw draw : {Draw::single, Draw::clusters, Draw::uncompressed})
        expect_cpu_pixels(model, draw, light, render(model, draw));
      expect_cpu_pixels(model, Draw::uncompressed, light,
                        render(model, Draw::uncompressed, 1, Sums::every_frame));
    }
  }
}

TEST_P(GlossyOnEveryApi, NormalsThatTurnAwayShowTheRim) {
  mesh::TriangleMesh mesh = torus(40, 20);
  for (std::size_t v = 0; v < mesh.normals.size(); ++v)  // half of them towards the far side
    if (v % 2 == 0)
      mesh.normals[v] = Vec3(mesh.normals[v].x, mesh.normals[v].y, -0.9f).normalized();
  const mesh::Scene scene = scene_of({mesh});
  const auto transfer = dimmed(random_transfer(scene.vertex_count(), 3, 1, 50, 4, 16));
  const Model model = make_model(scene, transfer, {});
  const sh::Light light = test_light(3);
  for (const ViewBasis basis : {ViewBasis::polynomial, ViewBasis::map}) {
    load(model, light, {.view_basis = basis});
    expect_cpu_pixels(model, Draw::single, light, render(model, Draw::single));
  }
}

TEST_P(GlossyOnEveryApi, MapAndPolynomialsAgree) {
  const mesh::Scene scene = scene_of({with_random_tangents(torus(40, 20))});
  for (const int row_count : {3, 16, 25, 36}) {
    const auto transfer = dimmed(random_transfer(scene.vertex_count(), 2, 1, 9, 2, row_count));
    const Model model = make_model(scene, transfer, {});
    load(model, test_light(2), {.view_basis = ViewBasis::map});
    const image::Image expected = render(model, Draw::single);
    load(model, test_light(2));
    EXPECT_LT(largest_difference(expected, render(model, Draw::single)), 1 / 255.0f) << row_count;
  }
}

TEST_P(GlossyOnEveryApi, FramesThatDisagreeLeaveNoSeams) {
  // Every vertex sends to the eye what arrives from there, so that the picture is known.
  const mesh::Scene scene = scene_of({with_random_tangents(torus(80, 40))});
  for (const int band_count : {3, 5}) {
    const signal::TransferSignal signal = passing_on(scene, band_count);
    const Model model = make_model(scene, in_pairs(signal), signal);
    const sh::Light light = test_light(band_count);
    const View view = view_of(model);
    load(model, light);
    for (const Draw draw : {Draw::single, Draw::uncompressed}) {
      const image::Image image = render(model, draw);
      std::size_t compared_count = 0;
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
          if (image.at(x, y)[3] < 1.0f) continue;
          ++compared_count;
          const Vec3 ray = view.camera.ray_direction((2 * static_cast<float>(x) + 1) / kWidth - 1,
                                                     1 - (2 * static_cast<float>(y) + 1) / kHeight);
          const Vec3 expected = light_radiance(light, -ray);
          for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.at(x, y)[c], expected[c], 0.02f);
        }
      EXPECT_GT(compared_count, 500u);
    }
  }
}

}  // namespace
}  // namespace prt::runtime
