// A signal that varies smoothly over a surface, some coefficients faster than others, as transfer
// does; the number of clusters and of vectors that it needs depends on the error that is allowed.
#pragma once

#include <cmath>
#include <vector>

#include "cpca/signals.h"

namespace prt::cpca {

inline std::vector<float> make_surface(std::size_t point_count, std::size_t dimension) {
  const auto places = random_values(2 * point_count, 21), rates = random_values(3 * dimension, 22);
  std::vector<float> signal;
  for (std::size_t p = 0; p < point_count; ++p) {
    for (std::size_t i = 0; i < dimension; ++i) {
      const float speed = 2.0f + 0.5f * static_cast<float>(i);
      const float angle =
          speed * (rates[3 * i] * places[2 * p] + rates[3 * i + 1] * places[2 * p + 1]);
      signal.push_back(std::sin(2.0f * angle + 6.0f * rates[3 * i + 2]) / speed);
    }
  }
  return signal;
}

}  // namespace prt::cpca
