// Ways of drawing transfer.
#include "runtime/renderer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "runtime/cluster_constants.h"
#include "runtime/every_api.h"

namespace prt::runtime {
namespace {

class EveryWay : public EveryApi {};
INSTANTIATE_TEST_SUITE_P(Renderer, EveryWay, every_api());

TEST_P(EveryWay, BothWaysOfDrawingCompressedTransferGiveTheSamePixels) {
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

TEST_P(EveryWay, SuperclustersLeaveThePixels) {
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

TEST_P(EveryWay, AdaptiveTransferDrawsAsItsPaddedTwinDoes) {
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

TEST_P(EveryWay, TablesOfMoreThanOneRowAreReadAcrossItsEnds) {
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

TEST_P(EveryWay, HalfFloatTargetsAddUpClustersToWithinAStepOfAPicture) {
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

TEST_P(EveryWay, FullRankCompressionDrawsLikeUncompressed) {
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

TEST_P(EveryWay, PixelsAgreeWithTheCpuTwin) {
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

TEST_P(EveryWay, WeightsOfEveryFormatAgreeWithTheCpuTwin) {
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

TEST_P(EveryWay, ModelWithTooManyComponentsIsRefusedAndTheOldOneStays) {
  const mesh::Scene scene = scene_of({sphere(8, 8)});
  const Lighting lighting = lighting_from(test_light(2));
  const Model good = make_model(scene, random_transfer(scene.vertex_count(), 2, 1, 2, 2), {});
  const image::Image before = render(good, Draw::single, lighting);
  EXPECT_THROW(renderer_.set_model(
                   make_model(scene, random_transfer(scene.vertex_count(), 2, 1, 2, 4000), {})),
               Error);
  EXPECT_EQ(largest_difference(before, renderer_.render(view_of(good), kWidth, kHeight, 1)), 0.0f);
}

TEST_P(EveryWay, WorksOnceOnAllChangesOfLightBeforeAFrame) {
  const mesh::Scene scene = scene_of({torus(20, 10)});
  const auto transfer = random_transfer(scene.vertex_count(), 3, 3, 4, 2);
  const Model model = make_model(scene, transfer, decompressed(transfer));
  renderer_.set_model(model);
  renderer_.set_lighting(lighting_from(test_light(3)));
  renderer_.set_near_lights({{Vec3(9, 0, 0), 1.0f, Vec3(1)}}, 3);
  renderer_.set_light_rotation(light_rotation(20));
  EXPECT_TRUE(renderer_.light_changed());
  EXPECT_EQ(renderer_.light_update_count(), 0);
  const View view = view_of(model);
  renderer_.draw(view, kWidth, kHeight, 1);
  renderer_.draw(view, kWidth, kHeight, 1);
  EXPECT_FALSE(renderer_.light_changed());
  EXPECT_EQ(renderer_.light_update_count(), 1);
  renderer_.set_light_rotation(light_rotation(40));
  renderer_.prepare(view);
  renderer_.draw(view, kWidth, kHeight, 1);
  EXPECT_EQ(renderer_.light_update_count(), 2);
}

}  // namespace
}  // namespace prt::runtime
