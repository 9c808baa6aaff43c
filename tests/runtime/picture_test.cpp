// What stands around and behind the model, and how a picture is developed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "image/environment.h"
#include "image/false_color.h"
#include "runtime/every_api.h"
#include "runtime/renderer.h"
#include "runtime/shading.h"

namespace prt::runtime {
namespace {

class Picture : public EveryApi {};
INSTANTIATE_TEST_SUITE_P(Renderer, Picture, every_api());

TEST_P(Picture, BackgroundAgreesWithTheEnvironmentOnTheCpu) {
  image::Image map(16, 8, 3);
  Pcg32 random(5);
  for (float& value : map.pixels) value = 3 * random.uniform();
  Model nothing;
  nothing.bounds = {Vec3(0), 1};
  View view = view_of(nothing);
  view.background = Background::environment;
  Lighting lighting = lighting_from(test_light(2));
  lighting.environment = map;
  renderer_.set_lighting(lighting);
  const float degrees = 37;
  const Matrix4 world_from_light = light_rotation(degrees);
  renderer_.set_light_rotation(world_from_light);
  const image::Image image = renderer_.render(view, kWidth, kHeight, 1);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const Vec3 ray = view.camera.ray_direction((2 * static_cast<float>(x) + 1) / kWidth - 1,
                                                 1 - (2 * static_cast<float>(y) + 1) / kHeight);
      const Vec3 expected =
          image::environment_radiance(map, transform_vector(world_from_light.transposed(), ray));
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.at(x, y)[c], expected[c], 1e-3f);
      EXPECT_EQ(image.at(x, y)[3], 0.0f);
    }
}

TEST_P(Picture, TurningTheLightIsTurningTheEnvironment) {
  const mesh::Scene scene = scene_of({sphere(24, 32)});
  const signal::TransferSignal signal = unshadowed(scene, 5, {{1, 0, 0}});
  const Model model = make_model(scene, full_rank(signal, 3), signal);
  const sh::Light light = test_light(5);
  const Matrix4 world_from_light = light_rotation(65);
  View view = view_of(model);
  view.background = Background::environment;
  renderer_.set_model(model);
  renderer_.set_lighting(lighting_from(light));
  renderer_.set_light_rotation(world_from_light);
  const image::Image turned = renderer_.render(view, kWidth, kHeight, 1);
  renderer_.set_lighting(lighting_from(sh::rotated(light, world_from_light)));
  renderer_.set_light_rotation(Matrix4());
  // The two backgrounds interpolate their maps at different places.
  EXPECT_LT(largest_difference(turned, renderer_.render(view, kWidth, kHeight, 1)), 5e-3f);
}

TEST_P(Picture, AlphaIsCoverageAndSamplesSmoothIt) {
  const mesh::Scene scene = scene_of({torus(60, 30)});
  const Model model = make_model(scene, random_transfer(scene.vertex_count(), 2, 1, 4, 2), {});
  const Lighting lighting = lighting_from(test_light(2));
  const auto partial_count = [](const image::Image& image) {
    std::size_t count = 0;
    for (std::size_t i = 3; i < image.pixels.size(); i += 4)
      count += image.pixels[i] > 0.0f && image.pixels[i] < 1.0f;
    return count;
  };
  EXPECT_EQ(partial_count(render(model, Draw::single, lighting, 1)), 0u);
  if (gl::limits().max_samples > 1) {
    EXPECT_GT(partial_count(render(model, Draw::single, lighting, 4)), 50u);
    EXPECT_GT(partial_count(render(model, Draw::clusters, lighting, 4)), 50u);
  }
}

TEST_P(Picture, EdgesOfWhatIsMuchBrighterThanWhiteAreSmooth) {
  if (!gl::limits().sample_textures || gl::limits().max_samples < 4) return;
  const mesh::Scene scene = scene_of({sphere(24, 32)});
  const Model model = make_model(scene, {}, unshadowed(scene, 2, {{1, 0, 0}}));
  View view = view_of(model);
  view.draw = Draw::uncompressed;
  view.background = Background::color;  // black
  renderer_.set_model(model);
  renderer_.set_lighting(lighting_from(sh::constant_light(2, Vec3(500))));
  const image::Image linear = renderer_.render(view, kWidth, kHeight, 4);
  const image::Image shown = renderer_.render(view, kWidth, kHeight, 4, true);
  for (std::size_t i = 0; i < shown.pixels.size(); i += 4) {
    EXPECT_EQ(shown.pixels[i + 3], linear.pixels[i + 3]);
    EXPECT_NEAR(shown.pixels[i], shown.pixels[i + 3], 0.02f);  // a white sphere's coverage
  }
}

TEST_P(Picture, BackFacesAreBlackAndCovered) {
  mesh::TriangleMesh inside_out = sphere(24, 32);
  for (std::size_t i = 0; i < inside_out.indices.size(); i += 3)
    std::swap(inside_out.indices[i], inside_out.indices[i + 1]);
  const mesh::Scene scene = scene_of({inside_out});
  const signal::TransferSignal signal = unshadowed(scene, 3, {{1, 0, 0}});
  const Model model = make_model(scene, full_rank(signal, 3), signal);
  for (const Draw draw : {Draw::single, Draw::clusters, Draw::uncompressed}) {
    const image::Image image = render(model, draw, lighting_from(test_light(3)));
    const float* const pixel = image.at(kWidth / 2, kHeight / 2);
    EXPECT_EQ(Vec4(pixel[0], pixel[1], pixel[2], pixel[3]), Vec4(0, 0, 0, 1));
  }
}

TEST_P(Picture, FalseColorsAreThoseOfTheCpu) {
  const mesh::Scene scene = scene_of({sphere(24, 32)});
  const signal::TransferSignal signal = unshadowed(scene, 3, {{1, 0, 0}});
  gltf::PrecomputedTransfer transfer = full_rank(signal, 1);
  const Model exact = make_model(scene, transfer, signal);
  View view = view_of(exact);
  const auto middle = [&](const Model& model, Show show) {
    renderer_.set_model(model);
    view.show = show;
    const image::Image image = renderer_.render(view, kWidth, kHeight, 1);
    const float* const pixel = image.at(kWidth / 2, kHeight / 2);
    return Vec3(pixel[0], pixel[1], pixel[2]);
  };
  EXPECT_LT((middle(exact, Show::error) - image::heat_color(0)).length(), 1e-3f);
  EXPECT_LT((middle(exact, Show::clusters) - image::cluster_color(0)).length(), 1e-5f);
  gltf::PrecomputedTransfer grouped = with_superclusters(full_rank(signal, 12), 4);
  for (std::uint32_t& cluster : grouped.encoding.cluster_of_point) cluster = 6;
  const Model group = make_model(scene, grouped, signal);
  EXPECT_LT((middle(group, Show::clusters) - image::cluster_color(6)).length(), 1e-5f);
  EXPECT_LT((middle(group, Show::superclusters) - image::cluster_color(1)).length(), 1e-5f);
  for (float& weight : transfer.encoding.weights) weight += 1.0f;
  EXPECT_LT(
      (middle(make_model(scene, transfer, signal), Show::error) - image::heat_color(1)).length(),
      1e-5f);
}

TEST_P(Picture, DevelopedPictureIsTheToneMapOfTheCpu) {
  const mesh::Scene scene = scene_of({sphere(24, 32)});
  const signal::TransferSignal signal = unshadowed(scene, 5, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  const Model model = make_model(scene, {}, signal);
  View view = view_of(model);
  view.draw = Draw::uncompressed;
  view.background = Background::environment;
  for (const float exposure : {-1.0f, 0.0f, 3.0f}) {
    view.exposure = exposure;
    renderer_.set_model(model);
    renderer_.set_lighting(lighting_from(test_light(5)));
    const image::Image linear = renderer_.render(view, kWidth, kHeight, 1);
    const gl::Target screen(gl::Format::rgba32f, kWidth, kHeight, false, 1);
    renderer_.draw(view, kWidth, kHeight, 1);
    screen.bind();
    renderer_.develop(view);
    std::vector<float> pixels(linear.pixels.size());
    screen.read(pixels);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const float* const radiance = linear.at(x, y);
        const Vec3 mapped =
            tone_map(Vec3(radiance[0], radiance[1], radiance[2]) * std::exp2(exposure));
        for (int c = 0; c < 3; ++c) {
          const float v = std::clamp(mapped[c], 0.0f, 1.0f);
          const float srgb = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
          const std::size_t row = static_cast<std::size_t>(kHeight - 1 - y);
          EXPECT_NEAR(pixels[4 * (row * kWidth + static_cast<std::size_t>(x)) +
                             static_cast<std::size_t>(c)],
                      srgb, 2e-3f);
        }
      }
  }
}

}  // namespace
}  // namespace prt::runtime
