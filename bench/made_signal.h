// A signal like transfer: a few families of points, each with variances that fall off, and noise.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "core/random.h"

namespace prt::bench {

/// point_count × dimension.
inline std::vector<float> make_signal(std::size_t point_count, std::size_t dimension) {
  constexpr std::size_t kFamilies = 4, kDirections = 12;
  Pcg32 random(3);
  std::vector<float> directions(kFamilies * kDirections * dimension);
  for (float& value : directions) value = random.uniform() - 0.5f;
  std::vector<float> signal(point_count * dimension);
  for (std::size_t p = 0; p < point_count; ++p) {
    float* row = &signal[p * dimension];
    const std::size_t family = random.below(kFamilies);
    for (std::size_t i = 0; i < dimension; ++i) row[i] = 0.02f * random.uniform();
    for (std::size_t d = 0; d < kDirections; ++d) {
      const float weight = (random.uniform() - 0.5f) * std::pow(0.7f, static_cast<float>(d));
      const float* direction = &directions[(family * kDirections + d) * dimension];
      for (std::size_t i = 0; i < dimension; ++i) row[i] += weight * direction[i];
    }
  }
  return signal;
}

}  // namespace prt::bench
