// The points that a survey encodes.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cpca/encoder.h"
#include "cpca/equal_rows.h"

namespace prt::cpca {

struct Sample {
  std::vector<float> rows, weights;  ///< empty: all points
  std::span<const float> signal, point_weights;
  std::size_t count = 0, all_count = 0;
  bool is_all = true;       ///< nothing is left out
  bool is_of_rows = false;  ///< one of each different row
  double energy = 0.0;

  double points_per_cluster(int cluster_count) const {
    return static_cast<double>(count) / cluster_count;
  }
};

/// A quarter of the points, but 128 at least, where there are as many.
std::size_t sample_count(std::size_t point_count);

/// So many points of a signal, drawn with the seed of the options, with their weights; or all.
Sample make_sample(std::span<const float> signal, std::size_t n, const Options& options);

/// One point of each different row, which weighs as much as all that are equal: errors of the root
/// mean square are those of the whole signal.
Sample make_sample(std::span<const float> signal, std::size_t n, const Options& options,
                   const EqualRows& rows);

}  // namespace prt::cpca
