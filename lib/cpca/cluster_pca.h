// Principal components of the points of one cluster about its mean [Sloan03] §4.1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace prt::cpca {

/// The affine subspace of a cluster: a mean and orthonormal vectors, some of them zero.
struct Subspace {
  std::span<const float> mean;  ///< n
  std::span<float> basis;       ///< component_count × n
};

/// Which matrix the eigenvectors come from; both span the same subspace.
enum class NormalForm {
  smaller,  ///< the smaller of the two
  inner,    ///< C^T C, n × n
  outer     ///< C C^T, m_k × m_k, and V^T = U^T D^-1 C
};

/// Fills `subspace.basis` with the principal components of `points` about the mean, largest
/// variance first. Those beyond the rank of the points are zero vectors. The sign is such that the
/// component of greatest magnitude is positive. Sums are in double: single precision would lose
/// components whose singular values are below 3e-4 of the largest.
/// `point_weights`, of all points of the signal or empty, weight the points' squares.
void find_components(std::span<const float> signal, std::span<const std::uint32_t> points,
                     const Subspace& subspace, std::span<const float> point_weights = {},
                     NormalForm form = NormalForm::smaller);

/// Weights of `points` in the subspace, (x_p - mean)·basis_i, into rows of `weights`, which is
/// (all points of the signal) × component_count.
void project(std::span<const float> signal, std::span<const std::uint32_t> points,
             const Subspace& subspace, std::span<float> weights);

}  // namespace prt::cpca
