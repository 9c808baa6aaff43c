// ‖a - b‖², the one loop that everything but the fused classification measures errors with.
#pragma once

#include <cassert>
#include <cstddef>
#include <span>

namespace prt::cpca {

/// Sixteen partial sums in double, added up in a fixed order.
inline double squared_distance(std::span<const float> a, std::span<const float> b) {
  assert(a.size() == b.size());
  constexpr std::size_t kLanes = 16;
  double sums[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= a.size(); i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const float difference = a[i + lane] - b[i + lane];
      sums[lane] += double{difference} * double{difference};
    }
  }
  double sum = 0.0;
  for (; i < a.size(); ++i) {
    const float difference = a[i] - b[i];
    sum += double{difference} * double{difference};
  }
  for (double part : sums) sum += part;
  return sum;
}

}  // namespace prt::cpca
