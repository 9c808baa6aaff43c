// What the tests of the encoders' kernels share.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/cpu.h"
#include "cpca/signals.h"
#include "cpca/subspaces.h"

namespace prt::cpca {

/// Clusters with random means and orthogonal vectors: cluster k has k % 4 of them, or many.
inline Subspaces make_subspaces(std::size_t n, std::size_t cluster_count, std::size_t many) {
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

struct Shape {
  std::size_t n, cluster_count, many, point_count;
};
inline const Shape kShapes[] = {{1, 1, 1, 1},    {3, 4, 2, 31},  {25, 7, 5, 33},
                                {64, 40, 9, 70}, {75, 9, 30, 5}, {100, 5, 14, 300}};

/// Those of this machine.
inline std::vector<SimdLevel> levels() {
  std::vector<SimdLevel> levels;
  for (SimdLevel level : {SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512}) {
    if (level <= simd_level()) levels.push_back(level);
  }
  return levels;
}

}  // namespace prt::cpca
