#include "sh/light.h"

#include <gtest/gtest.h>

#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/zonal.h"

namespace prt::sh {
namespace {

using std::numbers::pi;

TEST(Light, ConstantHasItsRadianceEverywhere) {
  Pcg32 random(1);
  const Light light = constant_light(5, {1, 2, 3});
  for (int i = 0; i < 20; ++i) {
    const Vec3 radiance = light_radiance(light, random_direction(random));
    EXPECT_NEAR(radiance.x, 1, 1e-6f);
    EXPECT_NEAR(radiance.y, 2, 1e-6f);
    EXPECT_NEAR(radiance.z, 3, 1e-6f);
  }
}

TEST(Light, FullDiskIsConstant) {
  const Light disk = disk_light(8, Vec3(1, 2, 3).normalized(), static_cast<float>(pi), {1, 1, 1});
  const Light constant = constant_light(8, {1, 1, 1});
  for (std::size_t i = 0; i < 64; ++i) {
    EXPECT_NEAR(disk.coefficients[0][i], constant.coefficients[0][i], 2e-6f) << i;
  }
}

TEST(Light, SmallDiskNearsADirectionalLightOfEqualIrradiance) {
  const float radius = 0.00465f;  // the sun's
  const float irradiance = static_cast<float>(pi) * std::pow(std::sin(radius), 2.0f);
  const Vec3 direction = Vec3(1, 2, -3).normalized();
  const Light disk = disk_light(6, direction, radius, Vec3(1 / irradiance));
  const Light directional = directional_light(6, direction, Vec3(1));
  for (std::size_t i = 0; i < 36; ++i) {
    EXPECT_NEAR(disk.coefficients[1][i], directional.coefficients[1][i], 3e-4f);
  }
}

// A map whose texels hold the share of a disk about +Y that lies in their row: the disk's edge is
// put on a row's edge, so the map is the disk exactly.
TEST(Light, DiskPaintedIntoAMapProjectsToTheClosedForm) {
  const int width = 64, height = 32, rows = 5, band_count = 10;
  std::vector<float> map(3 * width * height);
  for (int i = 0; i < 3 * width * rows; ++i) map[static_cast<std::size_t>(i)] = 2;
  const Light projected = project_environment(band_count, width, height, map.data());
  const auto radius = static_cast<float>(pi * rows / height);
  const Light disk = disk_light(band_count, {0, 1, 0}, radius, {2, 2, 2});
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_NEAR(projected.coefficients[2][i], disk.coefficients[2][i], 1e-6f) << i;
  }
}

TEST(Light, CosineLobeIsItsProjection) {
  const std::vector<double> lobe = cosine_lobe(12);
  std::vector<double> values(144);
  std::vector<double> expected(12);
  const GaussLegendre rule(40);
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    const double z = 0.5 * (1 + rule.nodes[k]);
    evaluate(12, std::sqrt(1 - z * z), 0.0, z, values);
    for (int l = 0; l < 12; ++l) {
      expected[static_cast<std::size_t>(l)] +=
          0.5 * rule.weights[k] * 2 * pi * z *
          values[static_cast<std::size_t>(coefficient_index(l, 0))];
    }
  }
  for (std::size_t l = 0; l < 12; ++l) EXPECT_NEAR(lobe[l], expected[l], 1e-13) << l;
  EXPECT_NEAR(lobe[0], 0.886227, 1e-6);
  EXPECT_NEAR(lobe[1], 1.023327, 1e-6);
  EXPECT_NEAR(lobe[2], 0.495416, 1e-6);
}

TEST(Light, WithBandCountKeepsTheLowBandsAndFillsWithZero) {
  const Light light = directional_light(4, {0, 1, 0}, {1, 2, 3});
  const Light fewer = with_band_count(light, 2);
  EXPECT_EQ(fewer.band_count, 2);
  ASSERT_EQ(fewer.coefficients[1].size(), 4u);
  EXPECT_EQ(fewer.coefficients[1][1], light.coefficients[1][1]);
  const Light more = with_band_count(light, 6);
  ASSERT_EQ(more.coefficients[1].size(), 36u);
  EXPECT_EQ(more.coefficients[1][15], light.coefficients[1][15]);
  EXPECT_EQ(more.coefficients[1][16], 0);
}

TEST(Light, RotatedSeesTheSameInTheTurnedDirection) {
  Pcg32 random(3);
  Light light(10);
  for (auto& channel : light.coefficients) channel = random_coefficients(100, random);
  const Matrix4 world_from_light = random_rotation(random);
  const Light turned = rotated(light, world_from_light);
  for (int i = 0; i < 100; ++i) {
    const Vec3 d = random_direction(random);
    const Vec3 before = light_radiance(light, d);
    const Vec3 after = light_radiance(turned, transform_vector(world_from_light, d));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(before[c], after[c], 1e-5f);
  }
}

}  // namespace
}  // namespace prt::sh
