#include "sh/radiance_metric.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "sh/basis.h"
#include "sh/hemisphere.h"
#include "sh/quadrature.h"

namespace prt::sh {
namespace {

constexpr std::size_t kColumns = 4;

std::vector<float> random_matrix(std::size_t row_count) {
  Pcg32 random(17);
  std::vector<float> matrix(row_count * kColumns);
  for (float& value : matrix) value = random.uniform() - 0.5f;
  return matrix;
}

/// Σ_j ∫ (Σ_i c_ij y_i)² over the upper hemisphere, exact for bands up to 8.
double radiance_squared(const std::vector<float>& matrix, int row_count) {
  const std::vector<int> functions = hemisphere_functions(row_count);
  const int band_count = band_count_of(functions);
  const GaussLegendre rule(16);
  constexpr int kSteps = 32;
  std::vector<float> y(static_cast<std::size_t>(coefficient_count(band_count)));
  double sum = 0.0;
  for (std::size_t k = 0; k < rule.nodes.size(); ++k)
    for (int step = 0; step < kSteps; ++step) {
      const double z = (rule.nodes[k] + 1) / 2, r = std::sqrt(1 - z * z);
      const double phi = 2 * std::numbers::pi * step / kSteps;
      evaluate(band_count, Vec3(Imath::V3d(r * std::cos(phi), r * std::sin(phi), z)), y);
      for (std::size_t j = 0; j < kColumns; ++j) {
        double radiance = 0.0;
        for (std::size_t i = 0; i < functions.size(); ++i)
          radiance +=
              double{matrix[i * kColumns + j]} * double{y[static_cast<std::size_t>(functions[i])]};
        sum += rule.weights[k] / 2 * 2 * std::numbers::pi / kSteps * radiance * radiance;
      }
    }
  return sum;
}

TEST(RadianceMetric, SquaresAreThoseOfRadianceOverTheHemisphere) {
  for (const int row_count : {4, 8, 16, 24, 25}) {
    std::vector<float> matrix = random_matrix(static_cast<std::size_t>(row_count));
    const double expected = radiance_squared(matrix, row_count);
    RadianceMetric(row_count, kColumns).apply(matrix);
    double square = 0.0;
    for (const float value : matrix) square += double{value} * double{value};
    EXPECT_NEAR(square, expected, 5e-3 * expected) << row_count;  // what hardly shows counts a bit
  }
}

TEST(RadianceMetric, IsUndone) {
  const RadianceMetric metric(25, kColumns);
  const std::vector<float> before = random_matrix(3 * 25);  // three channels
  std::vector<float> matrix = before;
  metric.apply(matrix);
  EXPECT_GT(std::abs(matrix[0] - before[0]), 1e-3f);
  metric.undo(matrix);
  for (std::size_t i = 0; i < matrix.size(); ++i) EXPECT_NEAR(matrix[i], before[i], 1e-5f);
}

TEST(RadianceMetric, LeavesDiffuseTransferAlone) {
  std::vector<float> row = random_matrix(1);
  const std::vector<float> before = row;
  RadianceMetric(1, kColumns).apply(row);
  EXPECT_EQ(row, before);
}

}  // namespace
}  // namespace prt::sh
