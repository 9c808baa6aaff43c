// Signals for the tests: noise about a few affine subspaces, like transfer over a surface.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/random.h"

namespace prt::cpca {

inline std::vector<float> random_values(std::size_t count, std::uint64_t seed) {
  Pcg32 random(seed);
  std::vector<float> values(count);
  for (float& value : values) value = random.uniform() - 0.5f;
  return values;
}

/// Points of `group_count` groups, each a mean and five directions of falling strength, plus noise.
inline std::vector<float> make_signal(std::size_t point_count, std::size_t dimension,
                                      std::size_t group_count = 3, std::uint64_t seed = 11) {
  constexpr std::size_t kDirections = 6;  // the first is the mean
  const auto vectors = random_values(group_count * kDirections * dimension, seed);
  auto signal = random_values(point_count * dimension, seed + 1);
  Pcg32 random(seed + 2);
  for (std::size_t p = 0; p < point_count; ++p) {
    const std::size_t group = random.below(static_cast<std::uint32_t>(group_count));
    for (std::size_t i = 0; i < dimension; ++i) signal[p * dimension + i] *= 0.01f;
    for (std::size_t d = 0; d < kDirections; ++d) {
      const float weight =
          d == 0 ? 2.0f : (random.uniform() - 0.5f) * std::pow(0.6f, static_cast<float>(d));
      const float* vector = &vectors[(group * kDirections + d) * dimension];
      for (std::size_t i = 0; i < dimension; ++i) signal[p * dimension + i] += weight * vector[i];
    }
  }
  return signal;
}

}  // namespace prt::cpca
