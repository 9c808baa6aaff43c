#include "sh/projection.h"

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/light.h"

namespace prt::sh {
namespace {

using std::numbers::pi;

std::vector<float> random_map(int width, int height) {
  Pcg32 random(31);
  std::vector<float> map(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (float& value : map) value = random.uniform();
  return map;
}

// Plain and slow: fine Gauss-Legendre squares inside each texel.
std::vector<double> project_plainly(int band_count, int width, int height, const float* rgb) {
  const auto count = row_size(band_count);
  std::vector<double> sums(3 * count), values(count);
  const GaussLegendre rule(16);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float* texel = rgb + 3 * (y * width + x);
      for (std::size_t a = 0; a < rule.nodes.size(); ++a) {
        const double latitude = pi * (0.5 - (y + 0.5 * (1 + rule.nodes[a])) / height);
        for (std::size_t b = 0; b < rule.nodes.size(); ++b) {
          const double longitude = pi * (1 - 2 * (x + 0.5 * (1 + rule.nodes[b])) / width);
          const double weight = rule.weights[a] * rule.weights[b] / 4 * (pi / height) *
                                (2 * pi / width) * std::cos(latitude);
          evaluate(band_count, std::sin(longitude) * std::cos(latitude), std::sin(latitude),
                   std::cos(longitude) * std::cos(latitude), values);
          for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t c = 0; c < 3; ++c) {
              sums[c * count + i] += weight * values[i] * double{texel[c]};
            }
          }
        }
      }
    }
  }
  return sums;
}

TEST(Projection, AgreesWithPlainQuadratureOfEveryTexel) {
  for (const auto& [width, height] : {std::pair{2, 1}, {4, 2}, {12, 6}, {17, 8}}) {
    const std::vector<float> map = random_map(width, height);
    const std::vector<double> expected = project_plainly(10, width, height, map.data());
    const Light light = project_environment(10, width, height, map.data());
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < 100; ++i) {
        ASSERT_NEAR(light.coefficients[c][i], expected[c * 100 + i], 2e-6)
            << width << ' ' << c << ' ' << i;
      }
    }
  }
}

TEST(Projection, ConstantMapIsTheConstantLight) {
  const std::vector<float> map(3 * 64 * 32, 1.0f);
  const Light light = project_environment(kMaxBandCount, 64, 32, map.data());
  const Light expected = constant_light(kMaxBandCount, Vec3(1));
  for (std::size_t i = 0; i < 256; ++i) {
    ASSERT_NEAR(light.coefficients[1][i], expected.coefficients[1][i], 1e-6f) << i;
  }
}

TEST(Projection, BrightTexelPointsWhereTheMapsConventionSays) {
  // The texel left of the middle of a quarter from the left: close to +X.
  const int width = 64, height = 33;
  std::vector<float> map(3 * 64 * 33);
  map[3 * (16 * 64 + 15)] = map[3 * (16 * 64 + 16)] = 1;
  const Light light = project_environment(3, width, height, map.data());
  const std::vector<float>& red = light.coefficients[0];
  EXPECT_NEAR(red[coefficient_index(1, 1)] / red[0], -std::sqrt(3.0f), 0.01f);
  EXPECT_NEAR(red[coefficient_index(1, 0)] / red[0], 0, 1e-5f);
  EXPECT_NEAR(red[coefficient_index(1, -1)] / red[0], 0, 1e-5f);
  EXPECT_EQ(light.coefficients[1][0], 0);
}

TEST(Projection, SameBytesForOneAndTwoThreads) {
  const std::vector<float> map = random_map(128, 64);
  set_thread_count(1);
  const Light one = project_environment(6, 128, 64, map.data());
  set_thread_count(2);
  const Light two = project_environment(6, 128, 64, map.data());
  set_thread_count(0);
  EXPECT_EQ(one.coefficients, two.coefficients);
}

TEST(Projection, TexelSolidAnglesSumToTheSphere) {
  for (const auto& [width, height] : {std::pair{2, 1}, {64, 32}, {1024, 512}}) {
    double sum = 0;
    for (int y = 0; y < height; ++y) sum += width * texel_solid_angle(width, height, y);
    EXPECT_NEAR(sum, 4 * pi, 1e-11);
  }
}

TEST(Projection, EnergyOfABandLimitedLightIsAllKept) {
  const std::vector<float> map(3 * 32 * 16, 2.0f);
  const std::array<double, 3> energy = environment_energy(32, 16, map.data());
  for (double channel : energy) EXPECT_NEAR(channel, 16 * pi, 1e-10);
}

}  // namespace
}  // namespace prt::sh
