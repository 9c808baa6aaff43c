#include "runtime/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "gl/context.h"
#include "image/environment.h"
#include "image/false_color.h"
#include "runtime/cluster_constants.h"
#include "runtime/glossy_models.h"
#include "runtime/models.h"
#include "runtime/pictures.h"
#include "runtime/shading.h"

namespace prt::runtime {
namespace {

class EveryApi : public testing::TestWithParam<gl::Api> {
 protected:
  gl::HeadlessContext context_{{.api = GetParam()}};
  Renderer renderer_;

  image::Image render(const Model& model, Draw draw, const Lighting& lighting, int samples = 1,
                      Sums sums = Sums::kept) {
    View view = view_of(model);
    view.draw = draw;
    view.sums = sums;
    renderer_.set_model(model);
    renderer_.set_lighting(lighting);
    return renderer_.render(view, kWidth, kHeight, samples);
  }
};
INSTANTIATE_TEST_SUITE_P(Renderer, EveryApi, testing::Values(gl::Api::core_3_3, gl::Api::es_3_0));

TEST_P(EveryApi, BothWaysOfDrawingCompressedTransferGiveTheSamePixels) {
  const mesh::Scene scene = scene_of({torus(60, 30)});
  for (const int channel_count : {1, 3})
    for (const int component_count : {0, 1, 8, 13}) {
      const Model model = make_model(
          scene, random_transfer(scene.vertex_count(), 4, channel_count, 40, component_count), {});
      const Lighting lighting = lighting_from(test_light(4));
      for (const int samples : {1, 4})
        EXPECT_LT(largest_difference(render(model, Draw::single, lighting, samples),
                                     render(model, Draw::clusters, lighting, samples)),
                  1e-3f)  // a quarter of 1/255; radiance reaches 10
            << channel_count << " channels, " << component_count << " components";
    }
}

TEST_P(EveryApi, SuperclustersLeaveThePixels) {
  const mesh::Scene scene = scene_of({torus(60, 30)});
  const Lighting lighting = lighting_from(test_light(3));
  const auto transfer = random_transfer(scene.vertex_count(), 3, 3, 61, 6);
  const image::Image expected = render(make_model(scene, transfer, {}), Draw::single, lighting);
  for (const int size : {1, 7, 61, 1000}) {
    const Model model = make_model(scene, with_superclusters(transfer, size), {});
    EXPECT_EQ(largest_difference(expected, render(model, Draw::single, lighting)), 0.0f);
    EXPECT_LT(largest_difference(expected, render(model, Draw::clusters, lighting)), 1e-3f) << size;
  }
}

TEST_P(EveryApi, AdaptiveTransferDrawsAsItsPaddedTwinDoes) {
  const mesh::Scene scene = scene_of({torus(60, 30)});
  const Lighting lighting = lighting_from(test_light(3));
  for (const int component_count : {0, 3, 13}) {
    auto transfer = with_superclusters(
        random_adaptive_transfer(scene.vertex_count(), 3, 3, 50, component_count), 9);
    const Model adaptive = make_model(scene, transfer, {});
    transfer.encoding.component_counts.clear();
    const image::Image expected = render(make_model(scene, transfer, {}), Draw::single, lighting);
    EXPECT_LT(largest_difference(expected, render(adaptive, Draw::single, lighting)), 1e-5f);
    EXPECT_LT(largest_difference(expected, render(adaptive, Draw::clusters, lighting)), 1e-3f);
  }
}

TEST_P(EveryApi, TablesOfMoreThanOneRowAreReadAcrossItsEnds) {
  // More than 4,096 constants and 3,200 vectors of weights: rows have 2048 elements of four
  // numbers.
  const mesh::Scene scene = scene_of({torus(80, 40)});
  const auto transfer = random_adaptive_transfer(scene.vertex_count(), 2, 3, 800, 9);
  ASSERT_GT(first_constants(transfer.encoding).back(), 2 * 2048u);
  const Model model = make_model(scene, transfer, {});
  const Lighting lighting = lighting_from(test_light(2));
  EXPECT_LT(largest_difference(render(model, Draw::single, lighting),
                               render(model, Draw::clusters, lighting)),
            1e-3f);
}

TEST_P(EveryApi, HalfFloatTargetsAddUpClustersToWithinAStepOfAPicture) {
  const mesh::Scene scene = scene_of({torus(60, 30)});
  auto transfer = random_transfer(scene.vertex_count(), 3, 3, 40, 4);
  for (float& value : transfer.encoding.means) value *= 0.3f;  // radiance of about 1
  for (float& value : transfer.encoding.bases) value *= 0.3f;
  const Model model = make_model(scene, transfer, {});
  const Lighting lighting = lighting_from(test_light(3));
  const image::Image expected = render(model, Draw::single, lighting);
  Renderer half(gl::Format::rgba16f);
  half.set_model(model);
  half.set_lighting(lighting);
  View view = view_of(model);
  for (const Draw draw : {Draw::single, Draw::clusters}) {
    view.draw = draw;
    EXPECT_LT(largest_difference(expected, half.render(view, kWidth, kHeight, 1)), 1.0f / 255.0f);
  }
}

TEST_P(EveryApi, SumsThatAreKeptAreThoseOfEveryFrame) {
  const mesh::Scene scene = scene_of({torus(60, 30)});
  const Lighting lighting = lighting_from(test_light(3));
  for (const auto& transfer : {random_transfer(scene.vertex_count(), 3, 3, 40, 0),
                               random_transfer(scene.vertex_count(), 3, 1, 40, 7),
                               random_adaptive_transfer(scene.vertex_count(), 3, 3, 40, 7)}) {
    const Model model = make_model(scene, transfer, decompressed(transfer));
    for (const Draw draw : {Draw::single, Draw::uncompressed})
      EXPECT_LT(largest_difference(render(model, draw, lighting, 1, Sums::kept),
                                   render(model, draw, lighting, 1, Sums::every_frame)),
                1e-4f);
  }
}

TEST_P(EveryApi, SumsThatAreKeptFollowTheLight) {
  const mesh::Scene scene = scene_of({torus(60, 30)});
  const auto transfer = random_transfer(scene.vertex_count(), 3, 3, 40, 7);
  const Model model = make_model(scene, transfer, decompressed(transfer));
  renderer_.set_model(model);
  renderer_.set_lighting(lighting_from(test_light(3)));
  for (const Draw draw : {Draw::single, Draw::uncompressed}) {
    View view = view_of(model);
    view.draw = draw;
    const auto render = [&](float degrees, Sums sums) {
      view.sums = sums;
      renderer_.set_light_rotation(light_rotation(degrees));
      return renderer_.render(view, kWidth, kHeight, 1);
    };
    const image::Image before = render(0, Sums::kept), after = render(90, Sums::kept);
    EXPECT_GT(largest_difference(before, after), 0.1f);
    EXPECT_LT(largest_difference(after, render(90, Sums::every_frame)), 1e-4f);
    EXPECT_EQ(largest_difference(before, render(0, Sums::kept)), 0.0f);
  }
}

TEST_P(EveryApi, FullRankCompressionDrawsLikeUncompressed) {
  const mesh::Scene scene = scene_of({sphere(24, 32), torus(48, 24)});
  for (const std::vector<Vec3>& albedo :
       {std::vector<Vec3>{{1, 0, 0}}, std::vector<Vec3>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}) {
    const int band_count = albedo.size() == 1 ? 5 : 3;
    const signal::TransferSignal signal = unshadowed(scene, band_count, albedo);
    const Model model = make_model(scene, full_rank(signal, 9), signal);
    const Lighting lighting = lighting_from(test_light(band_count));
    EXPECT_LT(largest_difference(render(model, Draw::single, lighting),
                                 render(model, Draw::uncompressed, lighting)),
              1e-4f);
  }
}

TEST_P(EveryApi, PixelsAgreeWithTheCpuTwin) {
  const mesh::Scene scene = scene_of({torus(80, 40)});
  const signal::TransferSignal signal = unshadowed(scene, 5, {{2, 1, 0}, {0, 1, 2}, {1, 2, 0}});
  // Clusters meet in nearly every triangle, and differ little: a pixel's exact place in its
  // triangle is not the rasteriser's to the last bit.
  gltf::PrecomputedTransfer transfer =
      with_superclusters(random_adaptive_transfer(scene.vertex_count(), 5, 3, 300, 6), 25);
  for (float& value : transfer.encoding.means) value *= 0.1f;
  for (float& value : transfer.encoding.bases) value *= 0.1f;
  const Model model = make_model(scene, transfer, signal);
  const sh::Light light = test_light(5);
  for (const Draw draw : {Draw::single, Draw::clusters, Draw::uncompressed})
    expect_cpu_pixels(model, draw, light, render(model, draw, lighting_from(light)));
}

TEST_P(EveryApi, WeightsOfEveryFormatAgreeWithTheCpuTwin) {
  const mesh::Scene scene = scene_of({torus(80, 40)});
  const sh::Light light = test_light(3);
  for (const auto format : {cpca::WeightFormat::float32, cpca::WeightFormat::float16,
                            cpca::WeightFormat::unorm16, cpca::WeightFormat::unorm8})
    for (const bool adaptive : {false, true}) {
      const auto make = adaptive ? random_adaptive_transfer : random_transfer;
      gltf::PrecomputedTransfer transfer =
          with_superclusters(make(scene.vertex_count(), 3, 3, 300, 6, 1), 25);
      cpca::Encoding& e = transfer.encoding;
      for (float& value : e.means) value *= 0.1f;
      // Every second component's weights are as small as half floats without a leading one.
      const auto n = static_cast<std::size_t>(e.dimension);
      for (std::size_t i = 0; i < e.weights.size(); i += 2)
        e.weights[i] = std::ldexp(e.weights[i], -14);
      for (std::size_t i = 0; i < e.bases.size(); ++i)
        e.bases[i] *= i / n % 2 == 0 ? std::ldexp(0.1f, 14) : 0.1f;
      cpca::convert_weights(format, e);
      transfer.weight_format = format;
      const Model model = make_model(scene, transfer, {});
      for (const Draw draw : {Draw::single, Draw::clusters})
        expect_cpu_pixels(model, draw, light, render(model, draw, lighting_from(light)));
    }
}

TEST_P(EveryApi, BackgroundAgreesWithTheEnvironmentOnTheCpu) {
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

TEST_P(EveryApi, TurningTheLightIsTurningTheEnvironment) {
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

TEST_P(EveryApi, AlphaIsCoverageAndSamplesSmoothIt) {
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

TEST_P(EveryApi, BackFacesAreBlackAndCovered) {
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

TEST_P(EveryApi, FalseColorsAreThoseOfTheCpu) {
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

TEST_P(EveryApi, DevelopedPictureIsTheToneMapOfTheCpu) {
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

TEST_P(EveryApi, ModelWithTooManyComponentsIsRefusedAndTheOldOneStays) {
  const mesh::Scene scene = scene_of({sphere(8, 8)});
  const Lighting lighting = lighting_from(test_light(2));
  const Model good = make_model(scene, random_transfer(scene.vertex_count(), 2, 1, 2, 2), {});
  const image::Image before = render(good, Draw::single, lighting);
  EXPECT_THROW(renderer_.set_model(
                   make_model(scene, random_transfer(scene.vertex_count(), 2, 1, 2, 4000), {})),
               Error);
  EXPECT_EQ(largest_difference(before, renderer_.render(view_of(good), kWidth, kHeight, 1)), 0.0f);
}

}  // namespace
}  // namespace prt::runtime
