// How errors of points count where an encoding is changed for storage, and what they must not
// exceed.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "cpca/encoding.h"

namespace prt::cpca {

struct ErrorLimits {
  std::span<const float> point_weights = {};               ///< of squared errors; empty: 1 each
  double total = std::numeric_limits<double>::infinity();  ///< weighted squared error of all points
  double point = std::numeric_limits<double>::infinity();  ///< and of each

  double weight(std::size_t p) const { return point_weights.empty() ? 1.0 : point_weights[p]; }
};

/// point_errors, each times its weight.
std::vector<double> weighted_errors(const Encoding& encoding, std::span<const float> signal,
                                    std::span<const float> point_weights);

}  // namespace prt::cpca
