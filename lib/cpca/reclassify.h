// Reclassification [Sloan03] §5: points move to clusters of their neighbours over the mesh where
// that saves triangles and costs little error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cpca/encoding.h"
#include "cpca/error_limits.h"

namespace prt::cpca {

/// What moving a point to another cluster would bring.
struct Move {
  std::uint32_t point = 0, cluster = 0;
  int reduction = 0;      ///< triangles that need not be sent any more
  double increase = 0.0;  ///< of the squared error; may be negative

  /// Reduction over increase; infinite where the error does not rise.
  double quotient() const;
};

/// The order of moves: greater quotient, then greater reduction, lower increase, lower point, lower
/// cluster.
bool is_better(const Move& a, const Move& b);

struct Reclassification {
  std::size_t moved_count = 0;  ///< moves; a point may move more than once
  double initial_error = 0.0;   ///< squared, weighted, over all points
  double final_error = 0.0;
};

/// Moves points while any move to a neighbour's cluster saves triangles, the best first, quotients
/// of a moved point and its neighbours kept current by a priority queue. Increases of the error add
/// up to at most `error_budget` (a share of the initial squared error); decreases are not spent
/// again. Neither do they exceed the limits, but no move is refused that lowers an error. Weights
/// of moved points are those of their projection on the new cluster's subspace, whose vectors must
/// be orthonormal or zero; means and bases stay. `signal` is point_count × dimension, every index <
/// point_count. The same result for any number of threads.
Reclassification reclassify(std::span<const float> signal, std::span<const std::uint32_t> indices,
                            double error_budget, Encoding& encoding,
                            const ErrorLimits& limits = {});

}  // namespace prt::cpca
