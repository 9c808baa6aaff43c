#include "cpca/clusters.h"

#include <numeric>

namespace prt::cpca {

PointsByCluster sort_by_cluster(std::span<const std::uint32_t> points,
                                std::span<const std::uint32_t> labels, std::size_t cluster_count) {
  PointsByCluster sorted{.offsets = std::vector<std::size_t>(cluster_count + 1),
                         .points = std::vector<std::uint32_t>(points.size())};
  for (std::uint32_t point : points) ++sorted.offsets[labels[point] + 1];
  std::partial_sum(sorted.offsets.begin(), sorted.offsets.end(), sorted.offsets.begin());
  std::vector<std::size_t> next = sorted.offsets;
  for (std::uint32_t point : points) sorted.points[next[labels[point]]++] = point;
  return sorted;
}

PointsByCluster sort_by_cluster(std::span<const std::uint32_t> labels, std::size_t cluster_count) {
  std::vector<std::uint32_t> all(labels.size());
  std::iota(all.begin(), all.end(), 0u);
  return sort_by_cluster(all, labels, cluster_count);
}

}  // namespace prt::cpca
