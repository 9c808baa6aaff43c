#include "cpca/clusters.h"

#include <numeric>

namespace prt::cpca {

namespace {

/// Counting sort of the points number(0), number(1), … number(count - 1).
template <class Number>
PointsByCluster sort(std::size_t count, std::span<const std::uint32_t> labels,
                     std::size_t cluster_count, Number number) {
  PointsByCluster sorted{.offsets = std::vector<std::size_t>(cluster_count + 1),
                         .points = std::vector<std::uint32_t>(count)};
  for (std::size_t i = 0; i < count; ++i) ++sorted.offsets[labels[number(i)] + 1];
  std::partial_sum(sorted.offsets.begin(), sorted.offsets.end(), sorted.offsets.begin());
  std::vector<std::size_t> next = sorted.offsets;
  for (std::size_t i = 0; i < count; ++i) {
    sorted.points[next[labels[number(i)]]++] = static_cast<std::uint32_t>(number(i));
  }
  return sorted;
}

}  // namespace

PointsByCluster sort_by_cluster(std::span<const std::uint32_t> points,
                                std::span<const std::uint32_t> labels, std::size_t cluster_count) {
  return sort(points.size(), labels, cluster_count, [&](std::size_t i) { return points[i]; });
}

PointsByCluster sort_by_cluster(std::span<const std::uint32_t> labels, std::size_t cluster_count) {
  return sort(labels.size(), labels, cluster_count, [](std::size_t i) { return i; });
}

std::vector<std::size_t> point_counts(const PointsByCluster& points) {
  std::vector<std::size_t> counts;
  for (std::size_t k = 0; k + 1 < points.offsets.size(); ++k) counts.push_back(points.of(k).size());
  return counts;
}

}  // namespace prt::cpca
