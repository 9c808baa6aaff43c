// Why points stay where they are, and a way on. A cluster of m points has bent its mean and its
// vectors to them, so that its error is smaller for each of them than it would be for the same
// point from outside, the more so the larger the share (1 + vectors) / m that one has in the fit.
// Classification by error alone mistakes that for a good place and ends early. Like the
// exchange algorithm of k-means (Hartigan 1975), which counts m / (m - 1) times the error of a
// point in its own cluster, but further: how far is a matter of trial. It counts points, as if all
// had the same weight.
#pragma once

#include <algorithm>
#include <cstddef>

namespace prt::cpca {

/// How many times the error of points in the cluster that they are in is to count.
inline float own_factor(std::size_t vector_count, std::size_t point_count) {
  constexpr float kShares = 6.0f, kMost = 0.5f;
  const float share = static_cast<float>(1 + vector_count) / static_cast<float>(point_count);
  return 1.0f + std::min(kShares * share, kMost);
}

}  // namespace prt::cpca
