#include "cpca/leading.h"

#include <algorithm>

#include "core/parallel.h"
#include "cpca/subspace_kernels.h"

namespace prt::cpca {

namespace {

/// What is left of a vector shorter than this, the others taken off, bounds nothing beyond
/// rounding.
constexpr double kLeast = 1e-6;

}  // namespace

Subspaces find_leading(const Subspaces& subspaces, std::size_t dimension) {
  const std::uint32_t most = *std::max_element(subspaces.used.begin(), subspaces.used.end());
  Subspaces leading(subspaces.cluster_count(), padded(dimension), most);
  leading.dimension = dimension;
  parallel_for(leading.cluster_count(), 16, [&](std::size_t begin, std::size_t end) {
    std::vector<double> rows;
    for (std::size_t k = begin; k < end; ++k) {
      std::copy_n(subspaces.mean(k), dimension, leading.mean(k));
      rows.clear();
      for (std::uint32_t i = 0; i < subspaces.used[k]; ++i) {
        rows.insert(rows.end(), subspaces.vector(k, i), subspaces.vector(k, i) + dimension);
      }
      const std::size_t kept = orthonormalize(rows, dimension, kLeast);
      for (std::size_t v = 0; v < kept; ++v) {
        std::copy_n(&rows[v * dimension], dimension, leading.vector(k, v));
      }
      leading.used[k] = leading.held[k] = static_cast<std::uint32_t>(kept);
    }
  });
  return leading;
}

}  // namespace prt::cpca
