// Vector quantisation by the LBG algorithm [Linde, Buzo, Gray 1980], which is k-means: the first
// half of static CPCA [Sloan03] §4.1.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/checkpoint.h"
#include "core/progress.h"

namespace prt::cpca {

struct Clustering {
  std::vector<float> means;           ///< cluster_count × dimension, of the points of each cluster
  std::vector<std::uint32_t> labels;  ///< cluster of each point
  int iterations = 0;                 ///< done
  int resumed_iterations = 0;         ///< of these, by an interrupted run
};

/// Classifies and averages, starting from `means`, at most `iterations` times, until no point
/// moves. A cluster that runs empty takes the point that adds most to the error; clusters stay
/// empty only when there is no error left. Points that are as near to one mean as to another go to
/// the lower. Preconditions: `signal` is finite; at least one iteration. `point_weights` of the
/// points in the means, >= 0, or empty; the mean of points that all weigh nothing stays. The state
/// of that name in the checkpoint, if any, follows the iterations.
Clustering quantize(std::span<const float> signal, std::size_t dimension, std::vector<float> means,
                    int iterations, std::span<const float> point_weights = {},
                    Checkpoint* checkpoint = nullptr, Checkpoint::Name name = {});

}  // namespace prt::cpca
