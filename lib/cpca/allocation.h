// How many vectors each cluster gets [Sloan03] §4.3.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt::cpca {

struct Allocation {
  std::vector<std::uint32_t> counts;  ///< n'_k
  double cost = 0.0;                  ///< the least D_i² / m_k among the vectors given: what one
                                      ///< weight more would save
};

/// Gives vectors to clusters in decreasing order of D_i²/m_k, the error that one saves for each
/// weight that it costs, as long as Σ_k m_k n'_k <= budget. What does not fit is left out, with the
/// later vectors of its cluster. `variances` are D_i², cluster × `most`, decreasing in each
/// cluster; those that are 0 are no vectors.
Allocation allocate(std::span<const double> variances, std::size_t most,
                    std::span<const std::size_t> point_counts, std::size_t budget);

}  // namespace prt::cpca
