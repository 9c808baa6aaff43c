// The generalized LBG algorithm of iterative and adaptive CPCA [Sloan03] §4.2, §4.3: points go to
// the cluster that approximates them best, then clusters fit their points.
//
// Most clusters are nowhere near most points. A full pass measures the error of every point in
// every cluster and notes which clusters are near the points of each; the passes after it try only
// those. As a point moves only to where its error is less, the error falls all the same. Of the
// clusters that are tried, the first coordinates (cpca/leading.h) rule out most.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/archive.h"
#include "cpca/clusters.h"
#include "cpca/subspace_kernels.h"
#include "cpca/subspaces.h"

namespace prt::cpca {

class Clusterer {
 public:
  /// Clusters with these means (cluster × stride of the rows) and no vectors; every point is in the
  /// first.
  Clusterer(const Rows& rows, std::size_t dimension, std::span<const float> means);

  struct Pass {
    double error_before = 0.0;  ///< Σ_p weight_p ‖x_p - x̃_p‖² with points where they were,
    double error = 0.0;         ///< and where they are now
    std::size_t moved_count = 0;  ///< points
  };
  /// Every point to the cluster of least error, all clusters tried or only near ones. Clusters that
  /// run empty take the points that add most to the error, as long as there is any left.
  /// With a vector_cost, what is least is the error plus that for each vector of the cluster. When
  /// `loose`, errors of points in the cluster that they are in count for more than they are
  /// (cpca/own_factor.h), so that the error may rise: a full pass that is not then finds all
  /// clusters as they were, for empty ones stay empty.
  Pass classify(bool full, float vector_cost = 0.0f, bool loose = false);

  /// Fits every cluster to its points, with as many vectors as `used` says, of the `held` >= used
  /// that it keeps.
  void update(std::span<const std::uint32_t> used, std::uint32_t held, int steps);

  /// As many vectors of each cluster count, of those that it holds.
  void set_used(std::span<const std::uint32_t> used);
  /// How many coordinates of the rows count. Means and vectors of more are right after update().
  void set_dimension(std::size_t dimension) { subspaces_.dimension = dimension; }
  /// Points to these clusters. Means and vectors are right after update().
  void set_labels(std::span<const std::uint32_t> labels);
  /// One more cluster for each of `parents`, at the end, which knows the same neighbours. Points to
  /// these clusters. Means and vectors are right after update().
  void grow(std::span<const std::uint32_t> parents, std::span<const std::uint32_t> labels);
  /// The same points in other coordinates. Clusters keep their points and nothing else.
  void set_rows(const Rows& rows);

  /// All that passes depend on but the rows, which must be the same.
  void archive(Archive& archive);

  const Subspaces& subspaces() const { return subspaces_; }
  const PointsByCluster& points() const { return sorted_; }
  const std::vector<std::uint32_t>& labels() const { return labels_; }
  /// ‖x_p - x̃_p‖² of each point, in the coordinates of the rows, after classify().
  const std::vector<float>& errors() const { return errors_; }
  /// Of products of points with means, vectors and one another that were computed.
  double flops() const { return flops_; }

 private:
  struct Block {
    std::size_t cluster;
    std::span<const std::uint32_t> points;
  };
  std::vector<Block> make_blocks() const;
  Classified classify_block(const Block& block, bool full, float vector_cost, bool loose,
                            std::size_t number);
  void merge_neighbours(std::span<const Block> blocks);
  /// Returns how many there were.
  std::size_t fill_empty_clusters();
  void count_clusters();

  Rows rows_;
  Subspaces subspaces_;
  std::optional<Subspaces> leading_;  ///< during a pass
  std::vector<std::uint32_t> labels_, all_clusters_;
  std::vector<float> errors_;
  PointsByCluster sorted_;
  std::size_t neighbour_count_ = 0;
  std::vector<std::uint32_t> neighbours_;  ///< cluster × neighbour_count_, the cluster itself first
  /// Of each block of a full pass, its nearest clusters and how near they are.
  std::vector<std::uint32_t> block_neighbours_;
  std::vector<float> block_affinities_;
  double flops_ = 0.0;
};

}  // namespace prt::cpca
