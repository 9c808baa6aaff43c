// The points that a survey encodes.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cpca/encoder.h"

namespace prt::cpca {

struct Sample {
  std::vector<float> rows, weights;  ///< empty: all points
  std::span<const float> signal, point_weights;
  std::size_t count = 0, all_count = 0;
  double energy = 0.0;

  double points_per_cluster(int cluster_count) const {
    return static_cast<double>(count) / cluster_count;
  }
};

/// A quarter of the points of a signal, but 128 at least, drawn with the seed of the options, with
/// their weights; or all, where they are.
Sample make_sample(std::span<const float> signal, std::size_t n, const Options& options);

}  // namespace prt::cpca
