#include "sh/window.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sh/basis.h"
#include "sh/light_edit.h"

namespace prt::sh {
namespace {

constexpr Window kAll[] = {Window::none, Window::hann, Window::lanczos, Window::automatic};

Light sun(int band_count) {
  return directional_light(band_count, Vec3(1, 2, 3).normalized(), {3, 2, 1});
}

/// A blue sky with a yellow sun, so that channels ring by different amounts.
Light sky_with_sun(int band_count) {
  return sum(constant_light(band_count, {0.1f, 0.2f, 0.6f}),
             disk_light(band_count, Vec3(1, 2, 3).normalized(), 0.1f, {60, 50, 30}));
}

TEST(Window, KeepsTheMeanAndReducesRinging) {
  const Light plain = sun(8);
  for (const Window window : kAll) {
    const WindowedLight soft = windowed(plain, window);
    EXPECT_EQ(soft.light.coefficients[0][0], plain.coefficients[0][0]);
    if (window == Window::none) continue;
    EXPECT_GT(statistics_of(soft.light).minimum_luminance,
              0.5 * statistics_of(plain).minimum_luminance)
        << name_of(window);
  }
}

TEST(Window, AutomaticIsTheWeakestThatDoesNotRing) {
  for (const int band_count : {2, 5, 10, 16}) {
    const Light plain = sky_with_sun(band_count);
    EXPECT_LT(ringing_of(plain).minimum_over_mean, -0.2) << band_count;
    EXPECT_GT(ringing_of(plain).negative_fraction, 0.05) << band_count;
    const WindowedLight soft = windowed(plain, Window::automatic);
    EXPECT_GT(soft.strength, 0);
    EXPECT_NEAR(soft.ringing.minimum_over_mean, -kRinging, 0.002) << band_count;
    EXPECT_EQ(soft.ringing.negative_fraction, 0);
  }
}

TEST(Window, AutomaticDampsAllChannelsAlike) {
  const Light plain = sky_with_sun(5);
  const WindowedLight soft = windowed(plain, Window::automatic);
  for (int l = 0; l < 5; ++l) {
    const double factor = std::exp(-soft.strength * l * (l + 1));
    const auto k = static_cast<std::size_t>(coefficient_index(l, 0));
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(soft.light.coefficients[c][k], factor * double{plain.coefficients[c][k]}, 1e-6);
  }
}

TEST(Window, AutomaticLeavesWhatDoesNotRing) {
  const Light dusk =
      sum(constant_light(4, {1, 2, 3}), disk_light(4, Vec3(0, 1, 0), 1.0f, {0.1f, 0.1f, 0.1f}));
  const WindowedLight same = windowed(dusk, Window::automatic);
  EXPECT_EQ(same.strength, 0);
  EXPECT_EQ(same.light.coefficients, dusk.coefficients);
}

TEST(Window, AutomaticSurvivesLightWithoutAMean) {
  Light dipole(2);
  for (auto& channel : dipole.coefficients) channel[2] = 1;
  EXPECT_EQ(windowed(dipole, Window::automatic).light.coefficients, dipole.coefficients);
  EXPECT_EQ(windowed(Light(), Window::automatic).light.band_count, 0);
  dipole.coefficients[1][0] = 1e-6f;  // needs a great strength
  EXPECT_GE(windowed(dipole, Window::automatic).ringing.minimum_over_mean, -1.01 * kRinging);
}

TEST(Ringing, IsOfTheChannelsAndOfTheirMeans) {
  Light light = constant_light(2, {5, 5, 5});
  EXPECT_NEAR(ringing_of(light).minimum_over_mean, 1, 1e-6);
  EXPECT_EQ(ringing_of(light).negative_fraction, 0);
  // Green is 1 + 2 z of its mean: less than -kRinging below z = -0.525.
  light.coefficients[1][2] = 2 * light.coefficients[1][0] / std::sqrt(3.0f);
  EXPECT_NEAR(ringing_of(light).minimum_over_mean, -1, 1e-3);
  EXPECT_NEAR(ringing_of(light).negative_fraction, (1 - (1 + kRinging) / 2) / 2, 1e-3);
}

}  // namespace
}  // namespace prt::sh
