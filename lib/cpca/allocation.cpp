#include "cpca/allocation.h"

#include <algorithm>

namespace prt::cpca {

Allocation allocate(std::span<const double> variances, std::size_t most,
                    std::span<const std::size_t> point_counts, std::size_t budget) {
  struct Candidate {
    double saving;
    std::uint32_t cluster, vector;
  };
  std::vector<Candidate> candidates;
  for (std::uint32_t k = 0; k < point_counts.size(); ++k) {
    for (std::uint32_t i = 0; i < most; ++i) {
      const double variance = variances[k * most + i];
      if (point_counts[k] == 0 || variance <= 0.0) continue;
      candidates.push_back({variance / static_cast<double>(point_counts[k]), k, i});
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    if (a.saving != b.saving) return a.saving > b.saving;
    return a.cluster != b.cluster ? a.cluster < b.cluster : a.vector < b.vector;
  });
  Allocation allocation{.counts = std::vector<std::uint32_t>(point_counts.size())};
  for (const auto& [saving, cluster, vector] : candidates) {
    if (allocation.counts[cluster] != vector || point_counts[cluster] > budget) continue;
    ++allocation.counts[cluster];
    budget -= point_counts[cluster];
    allocation.cost = saving;
  }
  return allocation;
}

}  // namespace prt::cpca
