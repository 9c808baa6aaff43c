#include "sh/rotation.h"

#include <gtest/gtest.h>

#include "sh/basis.h"
#include "sh/directions.h"

namespace prt::sh {
namespace {

constexpr int kBands = 10;
constexpr std::size_t kCount = 100;

TEST(ShRotation, RotatedFunctionIsTheFunctionSeenFromTheTurnedFrame) {
  Pcg32 random(11);
  for (int trial = 0; trial < 20; ++trial) {
    const Matrix4 to_from = random_rotation(random);
    const std::vector<float> from = random_coefficients(kCount, random);
    std::vector<float> to(kCount);
    Rotation(kBands, to_from).apply(from, to);
    for (int i = 0; i < 50; ++i) {
      const Vec3 d = random_direction(random);
      ASSERT_NEAR(evaluate_sum(kBands, to, transform_vector(to_from, d)),
                  evaluate_sum(kBands, from, d), 1e-5f);
    }
  }
}

TEST(ShRotation, AgreesWithDirectProjectionOfTheRotatedFunction) {
  Pcg32 random(12);
  const Matrix4 to_from = random_rotation(random);
  const Matrix4 from_to = to_from.transposed();
  const std::vector<float> from = random_coefficients(kCount, random);
  std::vector<double> projected(kCount), values(kCount), turned(kCount);
  for (const SphereNode& node : sphere_quadrature(2 * (kBands - 1))) {
    const Vec3 d(static_cast<float>(node.x), static_cast<float>(node.y),
                 static_cast<float>(node.z));
    const double f = double{evaluate_sum(kBands, from, transform_vector(from_to, d))};
    evaluate(kBands, node.x, node.y, node.z, values);
    for (std::size_t i = 0; i < kCount; ++i) projected[i] += node.weight * f * values[i];
  }
  std::vector<float> to(kCount);
  Rotation(kBands, to_from).apply(from, to);
  for (std::size_t i = 0; i < kCount; ++i) ASSERT_NEAR(to[i], projected[i], 1e-5) << i;
}

TEST(ShRotation, BlocksAreOrthogonalUpToTheLastBand) {
  Pcg32 random(13);
  const Rotation rotation(kMaxBandCount, random_rotation(random));
  for (int l = 0; l < kMaxBandCount; ++l) {
    for (int a = -l; a <= l; ++a) {
      for (int b = -l; b <= l; ++b) {
        double sum = 0;
        for (int n = -l; n <= l; ++n) sum += rotation.at(l, a, n) * rotation.at(l, b, n);
        ASSERT_NEAR(sum, a == b ? 1 : 0, 5e-6);  // the matrix itself is single precision
      }
    }
  }
}

TEST(ShRotation, TwoRotationsAreTheRotationOfTheProduct) {
  Pcg32 random(14);
  const Matrix4 b_from_a = random_rotation(random), c_from_b = random_rotation(random);
  const std::vector<float> a = random_coefficients(kCount, random);
  std::vector<float> b(kCount), c(kCount), direct(kCount);
  Rotation(kBands, b_from_a).apply(a, b);
  Rotation(kBands, c_from_b).apply(b, c);
  Rotation(kBands, b_from_a * c_from_b).apply(a, direct);  // row vectors: a first
  for (std::size_t i = 0; i < kCount; ++i) ASSERT_NEAR(c[i], direct[i], 1e-5f) << i;
}

TEST(ShRotation, IdentityChangesNothing) {
  Pcg32 random(15);
  const std::vector<float> from = random_coefficients(kCount, random);
  std::vector<float> to(kCount);
  Rotation(kBands, Matrix4()).apply(from, to);
  EXPECT_EQ(from, to);
}

TEST(ShRotation, QuarterTurnAboutZMixesSineAndCosine) {
  // x becomes y: cos(m phi) of the source is cos(m (phi - pi/2)).
  const Matrix4 to_from(0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
  std::vector<float> from(9), to(9);
  from[coefficient_index(1, 1)] = 1;
  from[coefficient_index(2, 2)] = 2;
  from[coefficient_index(2, 0)] = 3;
  Rotation(3, to_from).apply(from, to);
  EXPECT_NEAR(to[coefficient_index(1, -1)], 1, 1e-6f);
  EXPECT_NEAR(to[coefficient_index(1, 1)], 0, 1e-6f);
  EXPECT_NEAR(to[coefficient_index(2, 2)], -2, 1e-6f);
  EXPECT_NEAR(to[coefficient_index(2, 0)], 3, 1e-6f);
}

TEST(ShRotation, BatchAgreesWithSingleForAnyCountAndLeavesTheRestAlone) {
  Pcg32 random(16);
  const Matrix4 to_from = random_rotation(random);
  const std::size_t stride = 50;
  for (int band_count : {1, 2, 3, 5, 10, kMaxBandCount}) {
    const Rotation rotation(band_count, to_from);
    const auto size = row_size(band_count);
    const std::vector<float> from = random_coefficients(size * stride, random);
    for (std::size_t count : {0, 1, 15, 16, 17, 47}) {
      std::vector<float> to(size * stride, 1234), one(size), expected(size);
      rotation.apply_batch(from.data(), to.data(), count, stride);
      for (std::size_t v = 0; v < stride; ++v) {
        for (std::size_t i = 0; i < size; ++i) one[i] = from[i * stride + v];
        rotation.apply(one, expected);
        for (std::size_t i = 0; i < size; ++i) {
          if (v < count) {
            ASSERT_NEAR(to[i * stride + v], expected[i], 3e-6f);
          } else {
            ASSERT_EQ(to[i * stride + v], 1234);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace prt::sh
