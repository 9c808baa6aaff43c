// The fused kernels that classify points against sums one by one, at every SIMD level.
#include "cpca/subspace_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cpca/leading.h"
#include "cpca/random_subspaces.h"

namespace prt::cpca {
namespace {

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

TEST(Subspaces, KeepTheirVectorsWhenThereIsRoomForMore) {
  Subspaces subspaces = make_subspaces(40, 5, 3);
  const Subspaces before = subspaces;
  subspaces.reserve(2);
  EXPECT_EQ(subspaces.capacity, 3u);
  subspaces.reserve(7);
  EXPECT_EQ(subspaces.capacity, 7u);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(subspaces.values[k].capacity(), 8 * subspaces.stride);
    EXPECT_TRUE(std::equal(before.values[k].begin(), before.values[k].end(), subspaces.mean(k)));
    EXPECT_EQ(std::count(subspaces.vector(k, 3), subspaces.vector(k, 7), 0.0f),
              static_cast<std::ptrdiff_t>(4 * subspaces.stride));
  }
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

TEST(SubspaceKernels, ErrorsWherePointsAreMayCountMore) {
  constexpr std::size_t n = 20;
  const Subspaces subspaces = make_subspaces(n, 2, 3);
  const std::vector<float> point = random_values(n, 8);
  std::vector<std::uint32_t> points{0}, candidates{0, 1}, labels{9};
  if (error_in(subspaces, 1, point.data()) < error_in(subspaces, 0, point.data())) {
    std::swap(candidates[0], candidates[1]);  // it is in the better one
  }
  const double here = error_in(subspaces, candidates[0], point.data()),
               there = error_in(subspaces, candidates[1], point.data());
  std::vector<float> errors{9}, penalties{0.0f, 0.0f};
  for (const bool leaves : {false, true}) {
    classify({point.data(), 1, n}, subspaces,
             {.points = points,
              .candidates = candidates,
              .penalties = penalties,
              .labels = labels,
              .errors = errors,
              .own_factor = static_cast<float>(there / here * (leaves ? 1.01 : 0.99))});
    EXPECT_EQ(labels[0], candidates[leaves ? 1 : 0]);
    EXPECT_NEAR(errors[0], leaves ? there : here, 1e-4 * there);
  }
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

}  // namespace
}  // namespace prt::cpca
