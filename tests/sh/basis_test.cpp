#include "sh/basis.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "sh/directions.h"

namespace prt::sh {
namespace {

TEST(ShBasis, FirstBandsFollowTheConvention) {
  const Vec3 d = Vec3(0.3f, -0.5f, 0.8f).normalized();
  std::vector<float> values(9);
  evaluate(3, d, values);
  const float expected[] = {0.2820948f,
                            -0.4886025f * d.y,
                            0.4886025f * d.z,
                            -0.4886025f * d.x,
                            1.0925484f * d.x * d.y,
                            -1.0925484f * d.y * d.z,
                            0.3153916f * (3 * d.z * d.z - 1),
                            -1.0925484f * d.x * d.z,
                            0.5462742f * (d.x * d.x - d.y * d.y)};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(values[i], expected[i], 2e-7f) << i;
}

TEST(ShBasis, IsOrthonormal) {
  for (int band_count : {10, kMaxBandCount}) {
    const auto count = row_size(band_count);
    std::vector<double> products(count * count), values(count);
    for (const SphereNode& node : sphere_quadrature(2 * (band_count - 1))) {
      evaluate(band_count, node.x, node.y, node.z, values);
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = 0; j < count; ++j) {
          products[i * count + j] += node.weight * values[i] * values[j];
        }
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) {
        ASSERT_NEAR(products[i * count + j], i == j ? 1 : 0, 1e-12) << i << ' ' << j;
      }
    }
  }
}

TEST(ShBasis, BatchIsOrthonormalInSinglePrecision) {
  const int band_count = 10;
  const std::size_t count = 100;
  std::vector<float> x, y, z;
  const std::vector<SphereNode> nodes = sphere_quadrature(18);
  for (const SphereNode& node : nodes) {
    x.push_back(static_cast<float>(node.x));
    y.push_back(static_cast<float>(node.y));
    z.push_back(static_cast<float>(node.z));
  }
  std::vector<float> values(count * nodes.size());
  evaluate_batch(band_count, x.data(), y.data(), z.data(), nodes.size(), values.data(),
                 nodes.size());
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      double sum = 0;
      for (std::size_t d = 0; d < nodes.size(); ++d) {
        sum += nodes[d].weight * double{values[i * nodes.size() + d]} *
               double{values[j * nodes.size() + d]};
      }
      ASSERT_NEAR(sum, i == j ? 1 : 0, 1e-6) << i << ' ' << j;
    }
  }
}

// Made by tests/data/make_sh_scipy.py from scipy.special.sph_harm.
TEST(ShBasis, AgreesWithSciPy) {
  std::ifstream file("data/sh_scipy.json");
  const nlohmann::json data = nlohmann::json::parse(file);
  const int band_count = data.at("band_count");
  ASSERT_EQ(band_count, kMaxBandCount);
  const nlohmann::json& cases = data.at("cases");
  ASSERT_GE(cases.size(), 20u);
  std::vector<double> values(row_size(band_count));
  for (const nlohmann::json& one : cases) {
    const std::vector<double> d = one.at("direction"), expected = one.at("values");
    ASSERT_EQ(expected.size(), values.size());
    evaluate(band_count, d.at(0), d.at(1), d.at(2), values);
    for (std::size_t i = 0; i < values.size(); ++i) {
      ASSERT_NEAR(values[i], expected[i], 1e-12) << i;
    }
  }
}

TEST(ShBasis, BatchAgreesWithScalarForAnyCountAndLeavesTheRestAlone) {
  Pcg32 random(1);
  const std::size_t stride = 71;
  std::vector<float> x(stride), y(stride), z(stride), expected(256);
  for (std::size_t i = 0; i < stride; ++i) {
    const Vec3 d = random_direction(random);
    x[i] = d.x, y[i] = d.y, z[i] = d.z;
  }
  for (int band_count = 1; band_count <= kMaxBandCount; ++band_count) {
    const auto value_count = row_size(band_count);
    for (std::size_t count : {0, 1, 7, 15, 16, 17, 32, 67}) {
      std::vector<float> values(value_count * stride, 1234);
      evaluate_batch(band_count, x.data(), y.data(), z.data(), count, values.data(), stride);
      for (std::size_t d = 0; d < stride; ++d) {
        evaluate(band_count, Vec3(x[d], y[d], z[d]), expected);
        for (std::size_t i = 0; i < value_count; ++i) {
          // A band's values are at most sqrt((2l+1) / 4 pi) sqrt 2 < 2.3.
          if (d < count) {
            ASSERT_NEAR(values[i * stride + d], expected[i], 2e-6 * 2.3);
          } else {
            ASSERT_EQ(values[i * stride + d], 1234);
          }
        }
      }
    }
  }
}

TEST(ShBasis, SumIsTheDotProduct) {
  Pcg32 random(4);
  const std::vector<float> coefficients = random_coefficients(36, random);
  const Vec3 d = random_direction(random);
  std::vector<float> values(36);
  evaluate(6, d, values);
  float sum = 0;
  for (std::size_t i = 0; i < 36; ++i) sum += coefficients[i] * values[i];
  EXPECT_NEAR(evaluate_sum(6, coefficients, d), sum, 1e-5f);
}

// The addition theorem: a band's squares sum to (2l+1) / 4 pi in every direction, the poles too.
TEST(ShBasis, SquaresOfABandSumToAConstant) {
  std::vector<double> values(256);
  for (const Vec3& d : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(0, -1, 0)}) {
    evaluate(kMaxBandCount, d.x, d.y, d.z, values);
    for (int l = 0; l < kMaxBandCount; ++l) {
      double sum = 0;
      for (int m = -l; m <= l; ++m) {
        const double value = values[static_cast<std::size_t>(coefficient_index(l, m))];
        sum += value * value;
      }
      EXPECT_NEAR(sum, (2 * l + 1) / (4 * std::numbers::pi), 1e-12);
    }
  }
}

}  // namespace
}  // namespace prt::sh
