#include "sh/light_edit.h"

#include <gtest/gtest.h>

#include "sh/basis.h"
#include "sh/directions.h"

namespace prt::sh {
namespace {

void expect_equal(const Light& a, const Light& b, float tolerance) {
  ASSERT_EQ(a.band_count, b.band_count);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < a.coefficients[c].size(); ++i) {
      EXPECT_NEAR(a.coefficients[c][i], b.coefficients[c][i], tolerance) << c << ' ' << i;
    }
  }
}

TEST(LightEdit, QuarterTurnAboutYBringsFrontToTheRight) {
  const Light front = directional_light(6, {0, 0, 1}, {1, 2, 3});
  const Light right = directional_light(6, {1, 0, 0}, {1, 2, 3});
  expect_equal(edited(front, {.rotation = {0, 90, 0}}), right, 1e-5f);
}

TEST(LightEdit, RotatesAboutXBeforeY) {
  // About X by 90 degrees up becomes front, which about Y by 90 degrees becomes right.
  const Light up = directional_light(6, {0, 1, 0}, {1, 2, 3});
  const Light right = directional_light(6, {1, 0, 0}, {1, 2, 3});
  expect_equal(edited(up, {.rotation = {90, 90, 0}}), right, 1e-5f);
}

TEST(LightEdit, ExposureIsInStops) {
  const Light light = directional_light(3, {0, 1, 0}, {1, 2, 3});
  expect_equal(edited(light, {.exposure = 2}), directional_light(3, {0, 1, 0}, {4, 8, 12}), 1e-5f);
}

TEST(LightEdit, SumAddsRadianceAndPadsBands) {
  Light sky = constant_light(2, {1, 2, 3});
  Light sun = directional_light(4, {0, 1, 0}, {1, 1, 1});
  sky.source = "sky";
  sun.source = "sun";
  const Light both = sum(sky, sun);
  EXPECT_EQ(both.source, "sky + sun");
  ASSERT_EQ(both.band_count, 4);
  const Vec3 d = Vec3(1, 1, 1).normalized();
  const Vec3 expected = light_radiance(sky, d) + light_radiance(sun, d);
  EXPECT_NEAR(light_radiance(both, d).y, expected.y, 1e-5f);
}

TEST(LightStatistics, OfAConstantLight) {
  const LightStatistics statistics = statistics_of(constant_light(3, {2, 2, 2}));
  EXPECT_NEAR(statistics.energy, 3 * 4 * 4 * std::numbers::pi, 1e-4);
  EXPECT_NEAR(statistics.band_energy[0], statistics.energy, 1e-9);
  EXPECT_NEAR(statistics.minimum_luminance, 2, 1e-5);
  EXPECT_NEAR(statistics.maximum_luminance, 2, 1e-5);
  EXPECT_EQ(statistics.negative_fraction, 0);
}

TEST(LightStatistics, HalfOfADipoleIsNegative) {
  Light light(2);
  for (auto& channel : light.coefficients) channel[2] = 1;
  EXPECT_NEAR(statistics_of(light).negative_fraction, 0.5, 1e-6);
}

}  // namespace
}  // namespace prt::sh
