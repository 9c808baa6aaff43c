// The kernels that iterative encoders spend their time in, fused and tiled for registers like
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
  /// likely points are to move there; with own_factor the error of the one chosen is in its place.
  std::span<float> affinities = {};
  /// How many times the error in the cluster that points are in counts.
  float own_factor = 1.0f;
  /// find_leading() of the subspaces, if any: whole panels pass by candidates that they show to be
  /// too far. Labels and errors are the same with and without; such a candidate's share of the
  /// affinities is estimated.
  const Subspaces* leading = nullptr;
};

struct Classified {
  double error_before;  ///< Σ weight ‖x - x̃‖² in the cluster they are in
  double flops;         ///< of products of points with means and vectors that were computed
};

/// By ‖x - x̃‖² = ‖y‖² - 2 y·d + ‖d‖² - Σ_i (y·b_i - d·b_i)² ([Sloan03] §4.2), where y is relative
/// to the mean of the cluster that the point is in, and d the mean of the other relative to that:
/// what cancels is as small as can be. Where a thousandth and less is left, the square of
/// y - d - Σ_i (y·b_i - d·b_i) b_i takes its place, so that errors are right to a thousandth down
/// to 10⁻⁹ of ‖y‖² + ‖d‖².
Classified classify(const Rows& rows, const Subspaces& subspaces,
                    const Classification& classification, SimdLevel level = simd_level());

/// Some points of one cluster.
struct ClusterPoints {
  std::size_t number;
  std::span<const std::uint32_t> points;
};

/// Adds to `moments`, (1 + vector_count) × stride, with y_p = x_p - mean: Σ_p weight_p y_p, then
/// Σ_p weight_p (b_i·y_p) y_p of the first `vector_count` vectors of the cluster.
void add_moments(const Rows& rows, const Subspaces& subspaces, const ClusterPoints& cluster,
                 std::size_t vector_count, std::span<double> moments,
                 SimdLevel level = simd_level());

/// Moves the mean to that of the points, of `total_weight`, that `moments` are of, and the rows of
/// moments after the first along: they become V C, C the covariance about the new mean. `inner`
/// becomes V C V^T.
void centre_moments(double total_weight, Subspaces& subspaces, std::size_t cluster,
                    std::size_t vector_count, std::span<double> moments, std::span<double> inner,
                    SimdLevel level = simd_level());

/// The first `vector_count` vectors of the cluster become an orthonormal basis of `turn` × `rows`
/// (stride apart), from the first row on, without those that the ones before leave shorter than
/// `least`. Returns how many are left.
std::size_t turn_vectors(std::span<const double> rows, std::span<const double> turn, double least,
                         Subspaces& subspaces, std::size_t cluster, std::size_t vector_count,
                         SimdLevel level = simd_level());

/// The same of rows by themselves, in place.
std::size_t orthonormalize(std::span<double> rows, std::size_t length, double least,
                           SimdLevel level = simd_level());

/// Adds Σ_p weight_p x_p to `sums`, one for each coordinate that counts; rows of floats only.
void add_rows(const Rows& rows, std::span<const std::uint32_t> points, std::span<double> sums,
              SimdLevel level = simd_level());

}  // namespace prt::cpca
