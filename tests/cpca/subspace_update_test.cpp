// The kernels that move clusters after their points, against sums one by one, at every SIMD level.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "cpca/random_subspaces.h"
#include "cpca/subspace_kernels.h"

namespace prt::cpca {
namespace {

TEST(SubspaceUpdate, MomentsAboutTheNewMean) {
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

TEST(SubspaceUpdate, TurnedVectorsAreOrthonormalAndSpanTheRows) {
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
