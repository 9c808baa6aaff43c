// The fused kernels of iterative encoders against sums one by one, at every SIMD level.
#include "cpca/subspace_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cpca/leading.h"
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
      const auto [error_before, flops] = classify({values.data(), point_count, n}, subspaces,
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

TEST(SubspaceKernels, LeadingCoordinatesRuleOutButNeverDecide) {
  constexpr std::size_t n = 75, cluster_count = 40, point_count = 300;
  const Subspaces subspaces = make_subspaces(n, cluster_count, 9);
  const Subspaces leading = find_leading(subspaces, 32);
  // Points near the clusters, so that most of these are far.
  auto values = random_values(point_count * n, 8);
  for (std::size_t p = 0; p < point_count; ++p) {
    for (std::size_t i = 0; i < n; ++i) {
      values[p * n + i] = subspaces.mean(p % cluster_count)[i] + 0.3f * values[p * n + i];
    }
  }
  std::vector<std::uint32_t> points(point_count), candidates(cluster_count);
  std::iota(points.begin(), points.end(), 0u);
  std::iota(candidates.begin(), candidates.end(), 0u);
  const std::vector<float> penalties(cluster_count, 0.01f);
  for (SimdLevel level : levels()) {
    std::vector<std::uint32_t> labels[2];
    std::vector<float> errors[2];
    for (int i = 0; i < 2; ++i) {
      labels[i].resize(point_count);
      errors[i].resize(point_count);
      classify({values.data(), point_count, n}, subspaces,
               {.points = points,
                .candidates = candidates,
                .penalties = penalties,
                .labels = labels[i],
                .errors = errors[i],
                .leading = i == 0 ? nullptr : &leading},
               level);
    }
    EXPECT_EQ(labels[0], labels[1]);
    EXPECT_EQ(errors[0], errors[1]);
  }
  for (std::size_t p = 0; p < point_count; ++p) {
    for (std::size_t k = 0; k < cluster_count; ++k) {
      EXPECT_LE(error_in(leading, k, &values[p * n]),
                error_in(subspaces, k, &values[p * n]) + 1e-5);
    }
  }
}

/// Rows of 16 bits, and what they stand for.
struct ShortSignal {
  std::vector<std::int16_t> shorts;
  std::vector<float> scales, values;
  Rows rows() const {
    return {nullptr,      values.size() / scales.size(), scales.size(), {}, shorts.data(),
            scales.data()};
  }
};

ShortSignal make_shorts(std::size_t point_count, std::size_t stride) {
  ShortSignal signal;
  for (float value : random_values(stride, 3)) signal.scales.push_back(3e-5f * (1.0f + value));
  for (float value : random_values(point_count * stride, 4)) {
    signal.shorts.push_back(static_cast<std::int16_t>(60000.0f * value));
    signal.values.push_back(static_cast<float>(signal.shorts.back()) *
                            signal.scales[signal.values.size() % stride]);
  }
  return signal;
}

TEST(SubspaceKernels, RowsOfShortsAreAsGoodAsWhatTheyStandFor) {
  constexpr std::size_t n = 45, stride = 48, cluster_count = 7, point_count = 70;
  const ShortSignal signal = make_shorts(point_count, stride);
  const Rows floats{signal.values.data(), point_count, stride};
  EXPECT_EQ(signal.rows().at(3, 7), signal.values[3 * stride + 7]);
  const Subspaces subspaces = make_subspaces(n, cluster_count, 5);
  std::vector<std::uint32_t> points(point_count), candidates(cluster_count);
  std::iota(points.begin(), points.end(), 0u);
  std::iota(candidates.begin(), candidates.end(), 0u);
  const std::vector<float> penalties(cluster_count);
  for (SimdLevel level : levels()) {
    std::vector<std::uint32_t> labels[2];
    std::vector<float> errors[2];
    std::vector<double> moments[2];
    for (int i = 0; i < 2; ++i) {
      const Rows rows = i == 0 ? floats : signal.rows();
      labels[i].resize(point_count);
      errors[i].resize(point_count);
      classify(rows, subspaces,
               {.points = points,
                .candidates = candidates,
                .penalties = penalties,
                .labels = labels[i],
                .errors = errors[i]},
               level);
      moments[i].resize(3 * subspaces.stride);
      add_moments(rows, subspaces, {3, points}, 2, moments[i], level);
    }
    EXPECT_EQ(labels[0], labels[1]);
    for (std::size_t p = 0; p < point_count; ++p) EXPECT_NEAR(errors[0][p], errors[1][p], 1e-4);
    for (std::size_t d = 0; d < moments[0].size(); ++d) {
      if (d % subspaces.stride >= n) continue;
      EXPECT_NEAR(moments[0][d], moments[1][d], 1e-4);
    }
  }
}

TEST(SubspaceKernels, MomentsAboutTheNewMean) {
  for (SimdLevel level : levels()) {
    for (const auto& [n, cluster_count, many, point_count] : kShapes) {
      Subspaces subspaces = make_subspaces(n, cluster_count, many);
      const std::size_t k = cluster_count - 1, count = subspaces.held[k];
      const auto values = random_values(point_count * n, 8);
      auto weights = random_values(point_count, 9);
      for (float& weight : weights) weight += 0.5f;
      const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
      std::vector<std::uint32_t> points(point_count);
      std::iota(points.begin(), points.end(), 0u);
      std::vector<double> moments((1 + count) * subspaces.stride), inner(count * count);
      add_moments({values.data(), point_count, n, weights}, subspaces, {k, points}, count, moments,
                  level);
      centre_moments(total, subspaces, k, count, moments, inner, level);
      std::vector<double> mean(n), expected(count * n);
      for (std::size_t p = 0; p < point_count; ++p) {
        for (std::size_t i = 0; i < n; ++i) {
          mean[i] += double{weights[p]} * double{values[p * n + i]} / total;
        }
      }
      for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(subspaces.mean(k)[i], mean[i], 1e-6);
      for (std::size_t p = 0; p < point_count; ++p) {
        std::vector<double> y(n);
        for (std::size_t i = 0; i < n; ++i) y[i] = double{values[p * n + i]} - mean[i];
        for (std::size_t v = 0; v < count; ++v) {
          const double share = double{weights[p]} *
                               std::inner_product(y.begin(), y.end(), subspaces.vector(k, v), 0.0);
          for (std::size_t i = 0; i < n; ++i) expected[v * n + i] += share * y[i];
        }
      }
      for (std::size_t v = 0; v < count; ++v) {
        for (std::size_t i = 0; i < n; ++i) {
          EXPECT_NEAR(moments[(1 + v) * subspaces.stride + i], expected[v * n + i], 1e-4);
        }
        for (std::size_t u = 0; u < count; ++u) {
          EXPECT_NEAR(inner[v * count + u],
                      std::inner_product(&expected[v * n], &expected[v * n] + n,
                                         subspaces.vector(k, u), 0.0),
                      1e-4);
        }
      }
    }
  }
}

TEST(SubspaceKernels, TurnedVectorsAreOrthonormalAndSpanTheRows) {
  constexpr std::size_t n = 40, count = 5;
  for (SimdLevel level : levels()) {
    Subspaces subspaces = make_subspaces(n, 4, count);
    const std::size_t stride = subspaces.stride;
    const auto values = random_values(count * stride, 5), mix = random_values(count * count, 6);
    std::vector<double> rows(values.begin(), values.end()), turn(mix.begin(), mix.end());
    std::copy_n(rows.begin(), n, &rows[2 * stride]);  // the third is the first again
    ASSERT_EQ(turn_vectors(rows, turn, 1e-9, subspaces, 3, count, level), count - 1);
    for (std::size_t v = 0; v + 1 < count; ++v) {
      for (std::size_t u = 0; u <= v; ++u) {
        EXPECT_NEAR(std::inner_product(subspaces.vector(3, v), subspaces.vector(3, v) + n,
                                       subspaces.vector(3, u), 0.0),
                    u == v ? 1.0 : 0.0, 1e-6);
      }
    }
    for (std::size_t r = 0; r < count; ++r) {  // nothing of the rows is left outside
      std::vector<double> left(&rows[r * stride], &rows[r * stride] + n);
      for (std::size_t v = 0; v + 1 < count; ++v) {
        const float* vector = subspaces.vector(3, v);
        const double share = std::inner_product(left.begin(), left.end(), vector, 0.0);
        for (std::size_t i = 0; i < n; ++i) left[i] -= share * double{vector[i]};
      }
      EXPECT_NEAR(std::inner_product(left.begin(), left.end(), left.begin(), 0.0), 0.0, 1e-10);
    }
  }
}

}  // namespace
}  // namespace prt::cpca
