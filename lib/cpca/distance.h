// ‖a - b‖², the one loop that everything but the fused classification measures errors with.
#pragma once

#include <cassert>
#include <cstddef>
#include <span>

namespace prt::cpca {

constexpr std::size_t kDistanceLanes = 16;

/// Sixteen partial sums in double, added up in a fixed order. Squares of floats are exact in
/// double, so that every instruction set gives the same bits.
[[gnu::always_inline]] inline double squared_distance(std::span<const float> a,
                                                      std::span<const float> b) {
  assert(a.size() == b.size());
  double sums[kDistanceLanes] = {};
  std::size_t i = 0;
  for (; i + kDistanceLanes <= a.size(); i += kDistanceLanes) {
    for (std::size_t lane = 0; lane < kDistanceLanes; ++lane) {
      const float difference = a[i + lane] - b[i + lane];
      sums[lane] += double{difference} * double{difference};
    }
  }
  double rest = 0.0;
  for (; i < a.size(); ++i) {
    const float difference = a[i] - b[i];
    rest += double{difference} * double{difference};
  }
#pragma GCC unroll 4
  for (std::size_t half = kDistanceLanes / 2; half > 0; half /= 2) {
    for (std::size_t lane = 0; lane < half; ++lane) sums[lane] += sums[lane + half];
  }
  return sums[0] + rest;
}

}  // namespace prt::cpca
