#include "cpca/superclusters.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
#include <numeric>
#include <queue>
#include <tuple>

#include "cpca/overdraw.h"

namespace prt::cpca {

namespace {

/// Two superclusters as they were at their versions; low < high.
struct Pair {
  std::uint32_t gain, low, high, low_version, high_version;
  bool operator<(const Pair& other) const {  // the lesser comes later out of the queue
    return std::tuple(gain, other.low, other.high) < std::tuple(other.gain, low, high);
  }
};

class Merger {
 public:
  Merger(std::span<const std::uint32_t> indices, std::span<const std::uint32_t> cluster_of_point,
         std::span<const std::uint32_t> registers, std::uint32_t register_budget)
      : registers_(registers.begin(), registers.end()),
        register_budget_(register_budget),
        parents_(registers.size()),
        versions_(registers.size()),
        border_(registers.size()) {
    std::iota(parents_.begin(), parents_.end(), 0u);
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      const Corners corners{cluster_of_point[indices[i]], cluster_of_point[indices[i + 1]],
                            cluster_of_point[indices[i + 2]]};
      if (corners[0] == corners[1] && corners[0] == corners[2]) continue;
      for_each_label(corners[0], corners[1], corners[2],
                     [&](std::uint32_t cluster) { border_[cluster].push_back(corners); });
    }
    for (std::uint32_t cluster = 0; cluster < registers.size(); ++cluster) queue(cluster, cluster);
  }

  void run() {
    while (!queue_.empty()) {
      const Pair pair = queue_.top();
      queue_.pop();
      if (versions_[pair.low] != pair.low_version || versions_[pair.high] != pair.high_version)
        continue;
      merge(pair.low, pair.high);
    }
  }

  /// The lowest cluster of a cluster's supercluster.
  std::uint32_t root(std::uint32_t cluster) const {
    while (parents_[cluster] != cluster) cluster = parents_[cluster];
    return cluster;
  }

 private:
  using Corners = std::array<std::uint32_t, 3>;  // clusters of a triangle

  /// Queues pairs with the neighbours of `supercluster` from number `first` on.
  void queue(std::uint32_t supercluster, std::uint32_t first) {
    std::map<std::uint32_t, std::uint32_t> shared;
    for (const Corners& corners : border_[supercluster]) {
      for_each_label(root(corners[0]), root(corners[1]), root(corners[2]),
                     [&](std::uint32_t other) {
                       if (other >= first && other != supercluster) ++shared[other];
                     });
    }
    for (const auto& [other, gain] : shared) {
      if (std::uint64_t{registers_[supercluster]} + registers_[other] > register_budget_) continue;
      const auto [low, high] = std::minmax(supercluster, other);
      queue_.push({gain, low, high, versions_[low], versions_[high]});
    }
  }

  void merge(std::uint32_t low, std::uint32_t high) {
    // Triangles of both stand in both lists; those inside the two are border no more.
    std::vector<Corners> border;
    const auto add = [&](const std::vector<Corners>& triangles, bool also_of_low) {
      for (const Corners& corners : triangles) {
        int low_count = 0, high_count = 0;
        for (const std::uint32_t cluster : corners) {
          low_count += root(cluster) == low;
          high_count += root(cluster) == high;
        }
        if (low_count + high_count < 3 && (also_of_low || low_count == 0)) {
          border.push_back(corners);
        }
      }
    };
    add(border_[low], true);
    add(border_[high], false);
    border_[low] = std::move(border);
    border_[high] = {};
    parents_[high] = low;
    registers_[low] += registers_[high];
    ++versions_[low];
    ++versions_[high];
    queue(low, 0);
  }

  std::vector<std::uint32_t> registers_;
  std::uint32_t register_budget_;
  std::vector<std::uint32_t> parents_, versions_;
  std::vector<std::vector<Corners>> border_;  // triangles that have a corner elsewhere
  std::priority_queue<Pair> queue_;
};

}  // namespace

int registers_per_vector(int row_count) { return row_count == 1 ? 1 : (row_count + 3) / 4; }

std::vector<std::uint32_t> register_counts(const Encoding& encoding, int row_count) {
  std::vector<std::uint32_t> counts;
  for (int k = 0; k < encoding.cluster_count; ++k) {
    counts.push_back(static_cast<std::uint32_t>((encoding.component_count_of(k) + 1) *
                                                registers_per_vector(row_count)));
  }
  return counts;
}

std::vector<std::uint32_t> find_superclusters(std::span<const std::uint32_t> indices,
                                              std::span<const std::uint32_t> cluster_of_point,
                                              std::span<const std::uint32_t> register_counts,
                                              std::uint32_t register_budget) {
  Merger merger(indices, cluster_of_point, register_counts, register_budget);
  merger.run();
  std::vector<std::uint32_t> superclusters(register_counts.size());
  std::uint32_t count = 0;
  for (std::uint32_t cluster = 0; cluster < superclusters.size(); ++cluster) {
    const std::uint32_t root = merger.root(cluster);  // not above cluster
    superclusters[cluster] = root == cluster ? count++ : superclusters[root];
  }
  return superclusters;
}

std::vector<std::uint32_t> sort_clusters(std::span<const std::uint32_t> supercluster_of_cluster,
                                         Encoding& encoding) {
  const auto cluster_count = static_cast<std::uint32_t>(encoding.cluster_count);
  assert(supercluster_of_cluster.size() == cluster_count);
  std::vector<std::uint32_t> order(cluster_count), place(cluster_count);  // place inverts order
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return supercluster_of_cluster[a] < supercluster_of_cluster[b];
  });
  std::vector<std::uint32_t> first_clusters;
  for (std::uint32_t i = 0; i < cluster_count; ++i) {
    place[order[i]] = i;
    if (i == 0 || supercluster_of_cluster[order[i]] != supercluster_of_cluster[order[i - 1]]) {
      first_clusters.push_back(i);
    }
  }
  const auto reorder = [&](auto& values) {
    auto sorted = values;
    const std::size_t size = values.size() / cluster_count;
    for (std::size_t i = 0; i < cluster_count; ++i) {
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(order[i] * size), size,
                  sorted.begin() + static_cast<std::ptrdiff_t>(i * size));
    }
    values = std::move(sorted);
  };
  reorder(encoding.means);
  reorder(encoding.bases);
  reorder(encoding.component_counts);
  for (std::uint32_t& cluster : encoding.cluster_of_point) cluster = place[cluster];
  return first_clusters;
}

std::vector<std::uint32_t> superclusters_of_points(const Encoding& encoding,
                                                   std::span<const std::uint32_t> first_clusters) {
  std::vector<std::uint32_t> superclusters;
  superclusters.reserve(encoding.point_count);
  for (const std::uint32_t cluster : encoding.cluster_of_point) {
    const auto next = std::upper_bound(first_clusters.begin(), first_clusters.end(), cluster);
    superclusters.push_back(static_cast<std::uint32_t>(next - first_clusters.begin()) - 1);
  }
  return superclusters;
}

}  // namespace prt::cpca
