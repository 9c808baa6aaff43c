// The fused kernels of iterative encoders against sums one by one, at every SIMD level.
#include "cpca/subspace_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cpca/signals.h"

namespace prt::cpca {
namespace {

/// Clusters with random means and orthogonal vectors: cluster k has k % 4 of them, or many.
Subspaces make_subspaces(std::size_t n, std::size_t cluster_count, std::size_t many) {
  Subspaces subspaces(cluster_count, padded(n), many);
  subspaces.dimension = n;
  const auto values = random_values(cluster_count * (1 + many) * n, 7);
  for (std::size_t k = 0; k < cluster_count; ++k) {
    const std::size_t count = std::min({k % 4 == 3 ? many : k % 4, many, n});
    std::copy_n(&values[k * (1 + many) * n], n, subspaces.mean(k));
    for (std::size_t v = 0; v < count; ++v) {
      float* vector = subspaces.vector(k, v);
      std::copy_n(&values[(k * (1 + many) + 1 + v) * n], n, vector);
      for (std::size_t u = 0; u < v; ++u) {
        const float* other = subspaces.vector(k, u);
        const float share = std::inner_product(vector, vector + n, other, 0.0f);
        for (std::size_t i = 0; i < n; ++i) vector[i] -= share * other[i];
      }
      const float length = std::sqrt(std::inner_product(vector, vector + n, vector, 0.0f));
      for (std::size_t i = 0; i < n; ++i) vector[i] /= length;
    }
    subspaces.used[k] = subspaces.held[k] = static_cast<std::uint32_t>(count);
  }
  return subspaces;
}

double error_in(const Subspaces& subspaces, std::size_t k, const float* x) {
  const std::size_t n = subspaces.dimension;
  std::vector<double> y(n);
  double error = 0.0;
  for (std::size_t i = 0; i < n; ++i) y[i] = double{x[i]} - double{subspaces.mean(k)[i]};
  for (double value : y) error += value * value;
  for (std::uint32_t v = 0; v < subspaces.used[k]; ++v) {
    const double share = std::inner_product(y.begin(), y.end(), subspaces.vector(k, v), 0.0);
    error -= share * share;
  }
  return error;
}

struct Shape {
  std::size_t n, cluster_count, many, point_count;
};
const Shape kShapes[] = {{1, 1, 1, 1},    {3, 4, 2, 31},  {25, 7, 5, 33},
                         {64, 40, 9, 70}, {75, 9, 30, 5}, {100, 5, 14, 300}};

std::vector<SimdLevel> levels() {
  std::vector<SimdLevel> levels;
  for (SimdLevel level : {SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512}) {
    if (level <= simd_level()) levels.push_back(level);
  }
  return levels;
}

TEST(SubspaceKernels, PointsGoToTheClusterOfLeastError) {
  for (SimdLevel level : levels()) {
    for (const auto& [n, cluster_count, many, point_count] : kShapes) {
      const Subspaces subspaces = make_subspaces(n, cluster_count, many);
      const auto values = random_values(point_count * n, 8);
      std::vector<std::uint32_t> points(point_count), candidates(cluster_count),
          labels(point_count, ~0u);
      std::iota(points.begin(), points.end(), 0u);
      std::iota(candidates.begin(), candidates.end(), 0u);
      std::vector<float> errors(point_count), affinities(cluster_count), penalties(cluster_count);
      const double error_before = classify({values.data(), point_count, n}, subspaces,
                                           {.points = points,
                                            .candidates = candidates,
                                            .penalties = penalties,
                                            .labels = labels,
                                            .errors = errors,
                                            .affinities = affinities},
                                           level);
      std::vector<double> expected(cluster_count);
      double expected_before = 0.0;
      for (std::size_t p = 0; p < point_count; ++p) {
        std::vector<double> all;
        for (std::size_t k = 0; k < cluster_count; ++k) {
          all.push_back(error_in(subspaces, k, &values[p * n]));
        }
        expected_before += all[0];
        const double least = *std::min_element(all.begin(), all.end());
        ASSERT_LT(labels[p], cluster_count);
        EXPECT_NEAR(all[labels[p]], least, 1e-5 * (1.0 + least));
        EXPECT_NEAR(errors[p], least, 1e-5 * (1.0 + least));
        for (std::size_t k = 0; k < cluster_count; ++k) {
          expected[k] += std::pow((least + 1e-30) / (all[k] + 1e-30), 2.0);
        }
      }
      EXPECT_NEAR(error_before, expected_before, 1e-5 * (1.0 + expected_before));
      if (n < 25) continue;  // errors near 0 there have no ratio
      for (std::size_t k = 0; k < cluster_count; ++k) {
        EXPECT_NEAR(affinities[k], expected[k], 1e-3 * expected[k]);
      }
    }
  }
}

TEST(SubspaceKernels, PenaltiesDecideButAreNoError) {
  constexpr std::size_t n = 20;
  const Subspaces subspaces = make_subspaces(n, 2, 3);
  const std::vector<float> point(subspaces.mean(1), subspaces.mean(1) + n);
  const std::vector<std::uint32_t> points{0}, candidates{0, 1};
  std::vector<std::uint32_t> labels{9};
  std::vector<float> errors{9}, penalties{0.0f, 1e6f};
  classify({point.data(), 1, n}, subspaces,
           {.points = points,
            .candidates = candidates,
            .penalties = penalties,
            .labels = labels,
            .errors = errors});
  EXPECT_EQ(labels[0], 0u);
  EXPECT_NEAR(errors[0], error_in(subspaces, 0, point.data()), 1e-5);
  penalties[1] = 0.0f;
  classify({point.data(), 1, n}, subspaces,
           {.points = points,
            .candidates = candidates,
            .penalties = penalties,
            .labels = labels,
            .errors = errors});
  EXPECT_EQ(labels[0], 1u);
  EXPECT_NEAR(errors[0], 0.0, 1e-5);
}

TEST(SubspaceKernels, CovarianceTimesVectors) {
  for (SimdLevel level : levels()) {
    for (const auto& [n, cluster_count, many, point_count] : kShapes) {
      const Subspaces subspaces = make_subspaces(n, cluster_count, many);
      const std::size_t k = cluster_count - 1, count = subspaces.held[k];
      const auto values = random_values(point_count * n, 8);
      auto weights = random_values(point_count, 9);
      for (float& weight : weights) weight += 0.5f;
      std::vector<std::uint32_t> points(point_count);
      std::iota(points.begin(), points.end(), 0u);
      std::vector<double> product(count * subspaces.stride), expected(product.size());
      const Rows rows{values.data(), point_count, n, weights};
      multiply_by_covariance(rows, subspaces, {k, points}, count, product, level);
      for (std::size_t p = 0; p < point_count; ++p) {
        std::vector<double> y(n);
        for (std::size_t i = 0; i < n; ++i) y[i] = values[p * n + i] - subspaces.mean(k)[i];
        for (std::size_t v = 0; v < count; ++v) {
          const double share =
              weights[p] * std::inner_product(y.begin(), y.end(), subspaces.vector(k, v), 0.0);
          for (std::size_t i = 0; i < n; ++i) expected[v * subspaces.stride + i] += share * y[i];
        }
      }
      for (std::size_t i = 0; i < product.size(); ++i) EXPECT_NEAR(product[i], expected[i], 1e-4);
    }
  }
}

}  // namespace
}  // namespace prt::cpca
