// What every vertex sees, as SH coefficients: the visibility V of distant light above the horizon
// of the shading normal, 0 below it. With it light y_j becomes transferred radiance V y_j, whose
// moments T_ij = ∫ y_i V y_j need only the first 2n - 1 bands of V for n bands of i and j, since
// products of two functions have no others ([Sloan, Kautz, Snyder 2002] §4).
#pragma once

#include <cstdint>
#include <vector>

#include "core/mapped_array.h"
#include "transfer/diffuse.h"
#include "transfer/scene_index.h"

namespace prt::transfer {

struct VisibilityOptions {
  int band_count = 9;
  int ray_count = 2048;  ///< per vertex, over its hemisphere (on average)
  bool shadowed = true;  ///< false: no rays, the hemisphere alone
  std::uint64_t seed = 1;
};

struct Visibility {
  /// band_count² coefficients for each vertex, world frame: the hemisphere in closed form minus the
  /// sum over blocked directions, exact on a convex body. Rows of buried vertices are filled in
  /// from their neighbours (transfer/buried.h).
  MappedArray<float> rows;
  /// For each vertex itself, or for a buried one the vertex whose surroundings stand for its own.
  MappedArray<std::uint32_t> stand_ins;
};

/// The same bytes for any number of threads. Sets everything in `stats` but the bounces and
/// build_seconds. What rays found is kept in the checkpoint.
Visibility compute_visibility(const SceneIndex& index, const VisibilityOptions& options,
                              Checkpoint& checkpoint, DiffuseStats& stats);

/// C of T = V C: row k, column i·n² + j holds ∫ y_k y_i y_j over the sphere, for (2n-1)² rows and
/// n⁴ columns, n = band_count up to kMaxMatrixBandCount. By exact quadrature.
constexpr int kMaxMatrixBandCount = 8;
std::vector<float> triple_products(int band_count);

}  // namespace prt::transfer
