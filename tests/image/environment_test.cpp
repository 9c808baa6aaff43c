#include "image/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/random.h"
#include "temporary_folder.h"

namespace prt::image {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

Vec3 random_direction(Pcg32& random) {
  const float y = 2 * random.uniform() - 1, longitude = 2 * kPi * random.uniform();
  const float r = std::sqrt(1 - y * y);
  return {r * std::cos(longitude), y, r * std::sin(longitude)};
}

// A dim sky, one very bright texel, and some black rows.
Image sunny_map(int width, int height) {
  Image map(width, height, 3);
  Pcg32 random(5);
  for (int y = 0; y < height * 3 / 4; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) map.at(x, y)[c] = random.uniform();
    }
  }
  map.at(width / 3, height / 4)[1] = 20000;
  return map;
}

void expect_near(const Vec3& a, const Vec3& b, float tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Latlong, KnownCoordinatesLookAtKnownAxes) {
  expect_near(direction_from_latlong(0.5f, 0.5f), {0, 0, 1}, 1e-6f);
  expect_near(direction_from_latlong(0.25f, 0.5f), {1, 0, 0}, 1e-6f);
  expect_near(direction_from_latlong(0.75f, 0.5f), {-1, 0, 0}, 1e-6f);
  expect_near(direction_from_latlong(0.0f, 0.5f), {0, 0, -1}, 1e-6f);
  expect_near(direction_from_latlong(0.3f, 0.0f), {0, 1, 0}, 1e-6f);
  expect_near(direction_from_latlong(0.3f, 1.0f), {0, -1, 0}, 1e-6f);
}

TEST(Latlong, InverseReturnsTheCoordinates) {
  Pcg32 random(1);
  for (int i = 0; i < 1000; ++i) {
    const float u = random.uniform(), v = 0.01f + 0.98f * random.uniform();
    const Vec3 direction = direction_from_latlong(u, v);
    EXPECT_NEAR(direction.length(), 1, 1e-6f);
    const Vec2 uv = latlong_from_direction(direction);
    EXPECT_NEAR(uv.x, u, 2e-6f);
    EXPECT_NEAR(uv.y, v, 2e-6f);
  }
}

TEST(EnvironmentRadiance, AtATexelsCentreIsTheTexel) {
  const Image map = sunny_map(16, 8);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 16; ++x) {
      const Vec3 direction = direction_from_latlong((static_cast<float>(x) + 0.5f) / 16,
                                                    (static_cast<float>(y) + 0.5f) / 8);
      const float* texel = map.at(x, y);
      expect_near(environment_radiance(map, direction), {texel[0], texel[1], texel[2]}, 0.1f);
    }
  }
}

TEST(EnvironmentRadiance, WrapsAcrossTheSeam) {
  Image map(8, 4, 3);
  map.at(0, 2)[0] = 1;
  map.at(7, 2)[0] = 3;
  const Vec3 seam = direction_from_latlong(0, 2.5f / 4);
  EXPECT_NEAR(environment_radiance(map, seam).x, 2, 1e-5f);
}

TEST(EnvironmentSampler, DensityIntegratesToOne) {
  const int width = 32, height = 16;
  const EnvironmentSampler sampler(sunny_map(width, height));
  double sum = 0;
  for (int y = 0; y < height; ++y) {
    const double solid_angle =
        2 * std::numbers::pi / width *
        (std::cos(std::numbers::pi * y / height) - std::cos(std::numbers::pi * (y + 1) / height));
    for (int x = 0; x < width; ++x) {
      sum += solid_angle *
             sampler.pdf(direction_from_latlong((static_cast<float>(x) + 0.5f) / width,
                                                (static_cast<float>(y) + 0.5f) / height));
    }
  }
  EXPECT_NEAR(sum, 1, 1e-6);
}

TEST(EnvironmentSampler, SamplesCarryTheDensityOfTheirDirection) {
  const EnvironmentSampler sampler(sunny_map(64, 32));
  Pcg32 random(9);
  int equal_count = 0;
  for (int i = 0; i < 10000; ++i) {
    const auto sample = sampler.sample(random.uniform(), random.uniform());
    EXPECT_NEAR(sample.direction.length(), 1, 1e-6f);
    EXPECT_GT(sample.pdf, 0);
    equal_count += sample.pdf == sampler.pdf(sample.direction);
  }
  EXPECT_GT(equal_count, 9990);  // a direction on a texel's edge may round into the next one
}

TEST(EnvironmentSampler, EstimatesTheMapsIrradiance) {
  const Image map = sunny_map(64, 32);
  const EnvironmentSampler sampler(map);
  Pcg32 random(2);
  double by_light = 0, uniform = 0;
  const int count = 1 << 21;
  for (int i = 0; i < count; ++i) {
    const auto sample = sampler.sample(random.uniform(), random.uniform());
    by_light += environment_radiance(map, sample.direction).y / sample.pdf;
    uniform += environment_radiance(map, random_direction(random)).y * 4 * kPi;
  }
  // Uniform sampling: a texel of 20000 over about 1/650 of the sphere, relative deviation about 17,
  // so 0.012 of the mean after 2^21 samples; five of those.
  EXPECT_NEAR(by_light / uniform, 1, 0.06);
}

TEST(EnvironmentSampler, BlackMapIsUniform) {
  const EnvironmentSampler sampler(Image(16, 8, 3));
  EXPECT_NEAR(sampler.pdf({0, 1, 0}), 1 / (4 * kPi), 1e-6f);
  EXPECT_NEAR(sampler.sample(0.3f, 0.6f).pdf, 1 / (4 * kPi), 1e-6f);
}

TEST(EnvironmentFile, ClampsNegativeAndSpreadsGrey) {
  const TemporaryFolder folder;
  Image grey(4, 2, 1);
  grey.pixels = {1, 2, 3, 4, 5, 6, 7, -8};
  write_image(folder / "a.exr", grey);
  const Image map = read_environment(folder / "a.exr");
  ASSERT_EQ(map.channel_count, 3);
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(map.at(2, 1)[c], 7);
    EXPECT_EQ(map.at(3, 1)[c], 0);
  }
}

TEST(EnvironmentFile, RejectsOtherShapes) {
  const TemporaryFolder folder;
  write_image(folder / "a.exr", Image(16, 16, 3));
  try {
    read_environment(folder / "a.exr");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_NE(std::string(error.what()).find("16 x 16"), std::string::npos);
  }
}

}  // namespace
}  // namespace prt::image
