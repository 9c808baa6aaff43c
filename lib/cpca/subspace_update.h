// Principal components of clusters by subspace iteration from those of the iteration before: a
// classification moves few points, so a step or two follow it, at a small part of the cost of
// eigenvectors from scratch.
//
// With C the covariance of the points and V the vectors held, one step turns V to the axes of
// V C V^T (Rayleigh-Ritz) and replaces it by an orthonormal basis of the rows of V C. For positive
// semidefinite C neither lets the variance that the first i vectors capture fall, for any i:
// Σ_i v_i C v_i^T is convex, and its linear bound from V is greatest at the new basis. So the
// error of a cluster never rises.
#pragma once

#include <cstdint>
#include <span>

#include "cpca/subspaces.h"

namespace prt::cpca {

struct UpdateOptions {
  std::uint32_t used = 0;  ///< vectors to approximate with, as far as the points have so many
  std::uint32_t held = 0;  ///< vectors to keep, >= used: those beyond are ready when used grows
  int steps = 1;
};

/// Brings mean and vectors of a cluster up to its points; `errors` by number of the point. Vectors
/// that are missing start at the worst-approximated points. Of no points nothing changes.
void update_subspace(const Rows& rows, std::span<const std::uint32_t> points,
                     std::span<const float> errors, Subspaces& subspaces, std::size_t cluster,
                     const UpdateOptions& options);

}  // namespace prt::cpca
