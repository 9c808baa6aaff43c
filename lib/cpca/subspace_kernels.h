// The two products that iterative encoders spend their time on, fused and tiled for registers like
// cpca/nearest_mean.h. A panel of points stands transposed, coordinate by coordinate, in the first
// level cache; the vectors of one cluster after the other pass by it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/cpu.h"
#include "cpca/subspaces.h"

namespace prt::cpca {

/// Points of one cluster, and the clusters that they may go to.
struct Classification {
  std::span<const std::uint32_t> points;
  std::span<const std::uint32_t> candidates;  ///< the first is the cluster they are in
  std::span<const float> penalties;           ///< of each, compared with weighted errors
  /// Out, by number of the point: the best cluster and the error ‖x - x̃‖² in it. A point leaves its
  /// cluster only for one that is better by more than rounding.
  std::span<std::uint32_t> labels;
  std::span<float> errors;
  /// Out unless empty: for each candidate the sum over points of (least error / error there)²: how
  /// likely points are to move there.
  std::span<float> affinities = {};
};

/// By ‖x - x̃‖² = ‖y‖² - 2 y·d + ‖d‖² - Σ_i (y·b_i - d·b_i)² ([Sloan03] §4.2), where y is relative
/// to the mean of the cluster that the point is in, and d the mean of the other relative to that:
/// what cancels is as small as can be. Returns Σ weight ‖x - x̃‖² in the cluster they are in.
double classify(const Rows& rows, const Subspaces& subspaces, const Classification& classification,
                SimdLevel level = simd_level());

/// Some points of one cluster.
struct ClusterPoints {
  std::size_t number;
  std::span<const std::uint32_t> points;
};

/// Adds Σ_p weight_p (B y_p) y_p^T, y_p = x_p - mean, to `product`, where B are the first
/// `vector_count` vectors of the cluster: one power step for all of them, vector_count × stride.
void multiply_by_covariance(const Rows& rows, const Subspaces& subspaces,
                            const ClusterPoints& cluster, std::size_t vector_count,
                            std::span<double> product, SimdLevel level = simd_level());

/// Adds Σ_p weight_p x_p to `sums`, one for each coordinate that counts.
void add_rows(const Rows& rows, std::span<const std::uint32_t> points, std::span<double> sums,
              SimdLevel level = simd_level());

}  // namespace prt::cpca
