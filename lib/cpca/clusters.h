// Which points a cluster holds, as contiguous lists.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt::cpca {

/// Points in order of their cluster; within one, in order of their number.
struct PointsByCluster {
  std::vector<std::size_t> offsets;   ///< cluster_count + 1
  std::vector<std::uint32_t> points;  ///< those of cluster k are [offsets[k], offsets[k + 1])

  std::span<const std::uint32_t> of(std::size_t cluster) const {
    return std::span(points).subspan(offsets[cluster], offsets[cluster + 1] - offsets[cluster]);
  }
};

/// Counting sort of `points` by their labels; all labels < cluster_count.
PointsByCluster sort_by_cluster(std::span<const std::uint32_t> points,
                                std::span<const std::uint32_t> labels, std::size_t cluster_count);

/// The same for all points.
PointsByCluster sort_by_cluster(std::span<const std::uint32_t> labels, std::size_t cluster_count);

/// Points of each cluster.
std::vector<std::size_t> point_counts(const PointsByCluster& points);

}  // namespace prt::cpca
