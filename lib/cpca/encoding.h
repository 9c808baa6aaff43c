// Clustered PCA [Sloan03] §3.3: each point is approximated in the affine subspace of its cluster,
// x_p ≈ mean + Σ_i weight_i basis_i.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt::cpca {

struct Encoding {
  std::size_t point_count = 0;
  int dimension = 0;         ///< n
  int cluster_count = 0;     ///< m_c
  int component_count = 0;   ///< n', PCA vectors per cluster; adaptive CPCA: the most of a cluster
  std::vector<float> means;  ///< cluster_count × dimension
  /// cluster_count × component_count × dimension, orthonormal per cluster; vectors that a cluster
  /// does not have are zero, and so are the weights of its points for them.
  std::vector<float> bases;
  /// Of adaptive CPCA, the number of PCA vectors of each cluster; else empty: component_count each.
  std::vector<std::uint32_t> component_counts = {};
  std::vector<std::uint32_t> cluster_of_point;  ///< point_count
  std::vector<float> weights;                   ///< point_count × component_count

  /// n'_k: the PCA vectors of one cluster.
  int component_count_of(int cluster) const;
  std::span<const float> mean(int cluster) const;
  std::span<const float> basis(int cluster, int component) const;
};

/// x̃_p of one point into `row` (dimension floats).
void reconstruct(const Encoding& encoding, std::size_t point, std::span<float> row);

/// Squared error ‖x_p - x̃_p‖² of every point; `signal` is point_count × dimension. Sums are the
/// paper's SE.
std::vector<double> point_errors(const Encoding& encoding, std::span<const float> signal);

}  // namespace prt::cpca
