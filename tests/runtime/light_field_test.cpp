// Lights near the model.
#include "runtime/light_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "gl/context.h"
#include "runtime/glossy_models.h"
#include "runtime/pictures.h"

namespace prt::runtime {
namespace {

float coefficient_difference(const sh::Light& a, const sh::Light& b) {
  float largest = 0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t k = 0; k < a.coefficients[c].size(); ++k)
      largest = std::max(largest, std::abs(a.coefficients[c][k] - b.coefficients[c][k]));
  return largest;
}

TEST(NearLight, NumbersSayWhichKindItIs) {
  EXPECT_EQ(near_light(std::array{1.f, 2.f, 3.f, 4.f, 5.f, 6.f}).radius, 0);
  const NearLight sphere = near_light(std::array{1.f, 2.f, 3.f, 0.5f, 4.f, 5.f, 6.f});
  EXPECT_EQ(sphere.radius, 0.5f);
  EXPECT_EQ(sphere.color, Vec3(4, 5, 6));
  EXPECT_THROW(near_light(std::array{1.f, 2.f, 3.f, 4.f, 5.f}), Error);
  EXPECT_THROW(near_light(std::array{1.f, 2.f, 3.f, 0.f, 4.f, 5.f, 6.f}), Error);
  EXPECT_THROW(near_light(std::array{1.f, NAN, 3.f, 4.f, 5.f, 6.f}), Error);
}

TEST(NearLight, IsADiskOrADirectionFromEachPoint) {
  const Vec3 point(1, 0, 0), color(1, 2, 3);
  const NearLight sphere{Vec3(1, 2, 0), 1.0f, color};
  const float angle = std::numbers::pi_v<float> / 6;  // half as high as it is far
  EXPECT_LT(coefficient_difference(light_at({&sphere, 1}, 5, point),
                                   sh::disk_light(5, Vec3(0, 1, 0), angle, color)),
            1e-5f);
  EXPECT_LT(coefficient_difference(light_at({&sphere, 1}, 5, Vec3(1, 1.5f, 0)),
                                   sh::constant_light(5, color)),
            1e-5f);
  const NearLight lamp{Vec3(1, 2, 0), 0.0f, color};
  EXPECT_LT(coefficient_difference(light_at({&lamp, 1}, 5, point),
                                   sh::directional_light(5, Vec3(0, 1, 0), color / 4.0f)),
            1e-5f);
  const std::array both{sphere, lamp};
  EXPECT_GT(light_at(both, 1, point).coefficients[0][0],
            light_at({&lamp, 1}, 1, point).coefficients[0][0]);
}

LightGrid grid_of(int size) { return {size, Vec3(-1, -2, 0), Vec3(1, 2, 0)}; }  // flat in z

TEST(LightField, IsItsSamplesAtThePointsOfTheGrid) {
  const NearLight lamp{Vec3(3, 1, 2), 0.0f, Vec3(5)};
  const sh::Light distant = test_light(4);
  for (const int size : {1, 2, 4}) {
    const LightField field = light_field(distant, {&lamp, 1}, grid_of(size));
    ASSERT_EQ(field.samples.size(), field.grid.point_count());
    EXPECT_EQ(field.varies(), size > 1);
    for (std::size_t i = 0; i < field.samples.size(); ++i) {
      const Vec3 point = field.grid.point(i);
      sh::Light expected = light_at({&lamp, 1}, 4, point);
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t k = 0; k < 16; ++k)
          expected.coefficients[c][k] += distant.coefficients[c][k];
      EXPECT_LT(coefficient_difference(field.samples[i], expected), 1e-5f);
      EXPECT_LT(coefficient_difference(light_in(field, point), expected), 1e-5f);
    }
  }
  EXPECT_FALSE(light_field(distant, {}, grid_of(4)).varies());
}

TEST(LightField, FinerGridsComeNearerToTheLight) {
  const NearLight lamp{Vec3(3, 1, 2), 0.5f, Vec3(5)};
  float last = 1e9f;
  for (const int size : {1, 3, 5, 8}) {
    const LightField field = light_field(sh::Light(5), {&lamp, 1}, grid_of(size));
    float worst = 0;
    for (float x = -1; x <= 1; x += 0.125f)
      for (float y = -2; y <= 2; y += 0.25f)
        worst = std::max(worst, coefficient_difference(light_at({&lamp, 1}, 5, Vec3(x, y, 0)),
                                                       light_in(field, Vec3(x, y, 0))));
    EXPECT_LT(worst, 0.6f * last) << size;
    last = worst;
  }
}

class NearLightsOnEveryApi : public testing::TestWithParam<gl::Api> {
 protected:
  gl::HeadlessContext context_{{.api = GetParam()}};
  Renderer renderer_;
};
INSTANTIATE_TEST_SUITE_P(Renderer, NearLightsOnEveryApi,
                         testing::Values(gl::Api::core_3_3, gl::Api::es_3_0));

TEST_P(NearLightsOnEveryApi, PixelsAgreeWithTheCpuTwinHoweverDrawn) {
  const mesh::Scene scene = scene_of({torus(40, 20)});
  const std::vector<NearLight> lights{{Vec3(2, 1, 1), 0.3f, Vec3(9, 5, 2)},
                                      {Vec3(-2, 1, 0), 0.0f, Vec3(1, 2, 3)}};
  for (const int row_count : {1, 9}) {
    auto transfer = random_transfer(scene.vertex_count(), 3, 3, 50, 3, row_count);
    for (float& value : transfer.encoding.means) value *= 0.1f;
    for (float& value : transfer.encoding.bases) value *= 0.1f;
    const Model model = make_model(scene, transfer, decompressed(transfer));
    renderer_.set_model(model);
    renderer_.set_lighting(lighting_from(test_light(3)));
    for (const int size : {1, 3}) {
      renderer_.set_near_lights(lights, size);
      LightGrid grid{size, Vec3(1e9f), Vec3(-1e9f)};
      for (const Vec3& p : model.positions)
        for (int axis = 0; axis < 3; ++axis) {
          grid.low[axis] = std::min(grid.low[axis], p[axis]);
          grid.high[axis] = std::max(grid.high[axis], p[axis]);
        }
      const LightField field = light_field(test_light(3), lights, grid);
      for (const Draw draw : {Draw::single, Draw::clusters, Draw::uncompressed}) {
        View view = view_of(model);
        view.draw = draw;
        for (const Sums sums : {Sums::kept, Sums::every_frame}) {
          view.sums = sums;
          expect_cpu_pixels(model, draw, field, renderer_.render(view, kWidth, kHeight, 1));
        }
      }
    }
  }
}

}  // namespace
}  // namespace prt::runtime
