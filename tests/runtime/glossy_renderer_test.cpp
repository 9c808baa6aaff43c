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

class GlossyOnEveryApi : public testing::TestWithParam<gl::Api> {
 protected:
  gl::HeadlessContext context_{{.api = GetParam()}};
  Renderer renderer_;

  image::Image render(const Model& model, Draw draw, const sh::Light& light,
                      Passes passes = Passes::automatic, int samples = 1) {
    View view = view_of(model);
    view.draw = draw;
    renderer_.set_model(model, passes);
    renderer_.set_lighting(lighting_from(light));
    return renderer_.render(view, kWidth, kHeight, samples);
  }
};
INSTANTIATE_TEST_SUITE_P(Renderer, GlossyOnEveryApi,
                         testing::Values(gl::Api::core_3_3, gl::Api::es_3_0));

TEST_P(GlossyOnEveryApi, EveryWayOfDrawingGivesTheSamePixels) {
  const mesh::Scene scene = scene_of({with_random_tangents(torus(60, 30))});
  const sh::Light light = test_light(4);
  for (const int row_count : {3, 9, 16, 24, 25})
    for (const int channel_count : {1, 3}) {
      auto transfer = random_transfer(scene.vertex_count(), 4, channel_count, 40, 7, row_count);
      if (row_count == 24)
        transfer = with_superclusters(
            random_adaptive_transfer(scene.vertex_count(), 4, channel_count, 40, 7, row_count), 6);
      for (float& value : transfer.encoding.means) value *= 0.1f;  // radiance of about 1
      for (float& value : transfer.encoding.bases) value *= 0.1f;
      const Model model = make_model(scene, transfer, {});
      const image::Image expected = render(model, Draw::single, light, Passes::one);
      EXPECT_EQ(renderer_.pass_count(), 1);
      const auto differs = [&](Draw draw, Passes passes) {
        return largest_difference(expected, render(model, draw, light, passes));
      };
      EXPECT_LT(differs(Draw::clusters, Passes::one), 1 / 255.0f) << row_count;
      EXPECT_LT(differs(Draw::single, Passes::per_channel), 1e-4f) << row_count;
      EXPECT_EQ(renderer_.pass_count(), 3);
      EXPECT_LT(differs(Draw::clusters, Passes::per_channel), 1 / 255.0f) << row_count;
    }
}

TEST_P(GlossyOnEveryApi, SuperclustersAndSamplesLeaveThePixels) {
  const mesh::Scene scene = scene_of({torus(60, 30)});
  const sh::Light light = test_light(3);
  auto transfer = random_transfer(scene.vertex_count(), 3, 3, 61, 6, 9);
  for (float& value : transfer.encoding.means) value *= 0.1f;
  for (float& value : transfer.encoding.bases) value *= 0.1f;
  const Model plain = make_model(scene, transfer, {});
  for (const int size : {7, 1000}) {  // more than fits the uniforms is split
    const Model model = make_model(scene, with_superclusters(transfer, size), {});
    for (const int samples : {1, 4})
      EXPECT_LT(
          largest_difference(render(plain, Draw::single, light, Passes::automatic, samples),
                             render(model, Draw::clusters, light, Passes::automatic, samples)),
          1 / 255.0f);
  }
}

TEST_P(GlossyOnEveryApi, PixelsAgreeWithTheCpuTwin) {
  const mesh::Scene scene = scene_of({with_random_tangents(torus(40, 20))});
  // Random matrices: neighbours have nothing in common, and the highest bands are as strong as the
  // others. Radiance stays near 1.
  for (const int row_count : {9, 24, 25}) {
    auto transfer = with_superclusters(
        random_adaptive_transfer(scene.vertex_count(), 3, 3, 50, 6, row_count), 9);
    for (float& value : transfer.encoding.means) value *= 0.1f;
    for (float& value : transfer.encoding.bases) value *= 0.1f;
    signal::TransferSignal signal;
    signal.band_count = 3, signal.channel_count = 3, signal.row_count = row_count;
    signal.blocks = {{"torus", scene.vertex_count()}};
    signal.values.resize(scene.vertex_count() * static_cast<std::size_t>(signal.dimension()));
    for (std::size_t p = 0; p < scene.vertex_count(); ++p)
      cpca::reconstruct(transfer.encoding, p,
                        std::span(signal.values)
                            .subspan(p * static_cast<std::size_t>(signal.dimension()),
                                     static_cast<std::size_t>(signal.dimension())));
    const Model model = make_model(scene, transfer, signal);
    const sh::Light light = test_light(3);
    for (const Draw draw : {Draw::single, Draw::clusters, Draw::uncompressed})
      for (const Passes passes : {Passes::one, Passes::per_channel})
        expect_cpu_pixels(model, draw, light, render(model, draw, light, passes));
  }
}

TEST_P(GlossyOnEveryApi, NormalsThatTurnAwayShowTheRim) {
  mesh::TriangleMesh mesh = torus(40, 20);
  for (std::size_t v = 0; v < mesh.normals.size(); ++v)  // half of them towards the far side
    if (v % 2 == 0)
      mesh.normals[v] = Vec3(mesh.normals[v].x, mesh.normals[v].y, -0.9f).normalized();
  const mesh::Scene scene = scene_of({mesh});
  auto transfer = random_transfer(scene.vertex_count(), 3, 1, 50, 4, 16);
  for (float& value : transfer.encoding.means) value *= 0.1f;
  for (float& value : transfer.encoding.bases) value *= 0.1f;
  const Model model = make_model(scene, transfer, {});
  const sh::Light light = test_light(3);
  expect_cpu_pixels(model, Draw::single, light, render(model, Draw::single, light));
}

TEST_P(GlossyOnEveryApi, FramesThatDisagreeLeaveNoSeams) {
  // Every vertex sends to the eye what arrives from there, so that the picture is known.
  const mesh::Scene scene = scene_of({with_random_tangents(torus(80, 40))});
  for (const int band_count : {3, 5}) {
    const signal::TransferSignal signal = passing_on(scene, band_count);
    const Model model = make_model(scene, in_pairs(signal), signal);
    const sh::Light light = test_light(band_count);
    const View view = view_of(model);
    for (const Draw draw : {Draw::single, Draw::clusters, Draw::uncompressed}) {
      const image::Image image = render(model, draw, light);
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
