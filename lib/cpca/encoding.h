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
  int component_count = 0;   ///< n', PCA vectors per cluster
  std::vector<float> means;  ///< cluster_count × dimension
  std::vector<float>
      bases;  ///< cluster_count × component_count × dimension, orthonormal per cluster
  std::vector<std::uint32_t> cluster_of_point;  ///< point_count
  std::vector<float> weights;                   ///< point_count × component_count

  std::span<const float> mean(int cluster) const;
  std::span<const float> basis(int cluster, int component) const;
};

/// x̃_p of one point into `row` (dimension floats).
void reconstruct(const Encoding& encoding, std::size_t point, std::span<float> row);

/// Squared error ‖x_p - x̃_p‖² of every point; `signal` is point_count × dimension. Sums are the
/// paper's SE.
std::vector<double> point_errors(const Encoding& encoding, std::span<const float> signal);

}  // namespace prt::cpca
