// What one cluster makes of a signal: the same by all methods.
#pragma once

#include <span>
#include <vector>

#include "cpca/search_choice.h"

namespace prt::cpca {

struct OneCluster {
  std::vector<double> errors;  ///< relative, with no vectors, one, up to `component_count`
  double flops = 0.0;
};

/// Weights of all vectors are as many as numbers in the signal: those of some points are made at a
/// time. `point_weights` may be empty.
OneCluster measure_one_cluster(std::span<const float> signal, std::size_t dimension,
                               int component_count, Norm norm,
                               std::span<const float> point_weights);

}  // namespace prt::cpca
