// A sample of points.
#pragma once

#include <cstddef>
#include <vector>

#include "core/random.h"

namespace prt::cpca {

/// One point out of each of `drawn_count` equally long stretches of `point_count` points, at least
/// as many: in order.
inline std::vector<std::size_t> draw_points(std::size_t point_count, std::size_t drawn_count,
                                            Pcg32& random) {
  std::vector<std::size_t> points(drawn_count);
  for (std::size_t s = 0; s < drawn_count; ++s) {
    const std::size_t begin = s * point_count / drawn_count;
    const std::size_t length = (s + 1) * point_count / drawn_count - begin;
    points[s] = begin + random.below(static_cast<std::uint32_t>(length));
  }
  return points;
}

}  // namespace prt::cpca
