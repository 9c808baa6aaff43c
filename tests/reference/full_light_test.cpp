// The whole environment map as the light: importance sampling and cosine sampling together.
#include <gtest/gtest.h>

#include <cmath>

#include "reference/path_tracer.h"
#include "scenes.h"

namespace prt::reference {
namespace {

image::Image constant_map(float value) {
  image::Image map(64, 32, 3);
  std::fill(map.pixels.begin(), map.pixels.end(), value);
  return map;
}

TEST(FullLight, ConstantMapIsTheConstantLight) {
  mesh::Scene scene;
  add_sphere(scene, kPi / 2, kPi, true, add_material(scene, Vec3(0.8f)));
  const auto camera = look({0.0f, 4.0f, 0.5f}, {0.0f, -0.5f, 0.0f}, 25.0f);
  Options options;
  options.width = options.height = 32;
  options.sample_count = 256;
  const image::Image map = constant_map(2.0f);
  const Result full = trace(scene, camera, EnvironmentIllumination(map), options);
  const BandLimitedIllumination constant(sh::constant_light(4, Vec3(2.0f)));
  options.seed = 2;
  const Result limited = trace(scene, camera, constant, options);
  double sum_full = 0.0, sum_limited = 0.0, difference = 0.0, noise = 0.0;
  for (std::size_t i = 0; i < std::size_t{32} * 32; ++i) {
    const double a = full.radiance.pixels[4 * i], b = limited.radiance.pixels[4 * i];
    sum_full += a;
    sum_limited += b;
    difference += (a - b) * (a - b);
    noise += std::pow(full.standard_error.pixels[3 * i], 2) +
             std::pow(limited.standard_error.pixels[3 * i], 2);
  }
  EXPECT_GT(sum_full, 0.0);
  EXPECT_NEAR(sum_full / sum_limited, 1.0, 4 * std::sqrt(noise) / sum_limited + 1e-5);
  EXPECT_NEAR(difference / noise, 1.0, 0.25);
}

// A sun of a few texels, 10,000 times as bright as the sky: irradiance of a floor by quadrature.
TEST(FullLight, SmallSunIsSampledWell) {
  image::Image map = constant_map(0.1f);
  for (int x = 20; x < 22; ++x) std::fill_n(map.at(x, 9), 3, 1000.0f);
  const Matrix4 world_from_light = Matrix4().rotate(Vec3(0.0f, 1.2f, 0.0f));
  double irradiance = 0.0;
  constexpr int kWidth = 2048, kHeight = 1024;
  for (int y = 0; y < kHeight / 2; ++y) {
    const double colatitude = (y + 0.5) / kHeight * std::numbers::pi;
    for (int x = 0; x < kWidth; ++x) {
      const Vec3 direction = image::direction_from_latlong(
          (static_cast<float>(x) + 0.5f) / kWidth, (static_cast<float>(y) + 0.5f) / kHeight);
      irradiance += image::environment_radiance(map, direction).x * direction.y *
                    std::sin(colatitude) * 2.0 * std::numbers::pi * std::numbers::pi /
                    (double{kWidth} * kHeight);
    }
  }
  mesh::Scene scene;
  add_quad(scene, {-9.0f, 0.0f, 9.0f}, {18.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -18.0f},
           add_material(scene, Vec3(0.5f)));
  const auto camera = look({0.0f, 5.0f, 5.0f}, {0.0f, 0.0f, 0.0f}, 20.0f);
  Options options;
  options.width = options.height = 16;
  options.sample_count = 64;
  const Result result =
      trace(scene, camera, EnvironmentIllumination(map, world_from_light), options);
  double mean = 0.0, variance = 0.0;
  for (std::size_t i = 0; i < 256; ++i) {
    mean += result.radiance.pixels[4 * i] / 256.0;
    variance += std::pow(result.standard_error.pixels[3 * i], 2) / 256.0;
  }
  const double expected = 0.5 * irradiance / std::numbers::pi;
  EXPECT_NEAR(mean, expected, 4 * std::sqrt(variance / 256.0) + 1e-3 * expected);
  EXPECT_LT(std::sqrt(variance), 0.1 * expected);  // 1.6 by cosine sampling alone
}

// Turning the light and the scene together about the view axis changes nothing but the picture's
// orientation: here a light from one side makes that side of a sphere bright.
TEST(FullLight, RotationTurnsTheLightAsDocumented) {
  image::Image map = constant_map(0.0f);
  for (int y = 14; y < 18; ++y) std::fill_n(map.at(30, y), 12, 100.0f);  // around +Z
  const Matrix4 world_from_light =
      Matrix4().rotate(Vec3(0.0f, std::numbers::pi_v<float> / 2.0f, 0.0f));
  ASSERT_GT(transform_vector(world_from_light, Vec3(0.0f, 0.0f, 1.0f)).x, 0.99f);
  mesh::Scene scene;
  add_sphere(scene, 0.0f, kPi, false, add_material(scene, Vec3(1.0f)));
  const auto camera = look({0.0f, 0.0f, 6.0f}, {0.0f, 0.0f, 0.0f}, 20.0f);
  Options options;
  options.width = options.height = 32;
  options.sample_count = 16;
  const Result result =
      trace(scene, camera, EnvironmentIllumination(map, world_from_light), options);
  EXPECT_GT(result.radiance.at(26, 16)[0], 0.3f);  // +X is on the right
  EXPECT_LT(result.radiance.at(5, 16)[0], 1e-3f);
}

}  // namespace
}  // namespace prt::reference
