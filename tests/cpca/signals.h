// Signals for the tests: noise about a few affine subspaces, like transfer over a surface.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/random.h"
#include "cpca/encoder.h"
#include "cpca/figures.h"

namespace prt::cpca {

inline double error_of(const Encoded& encoded, const std::vector<float>& signal) {
  return summarize(point_errors(encoded.encoding, signal), signal).squared_error;
}

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

/// Waves over a square, points row by row of a grid: no noise, so that the error of clusters falls
/// with their vectors to the end of single precision.
inline std::vector<float> make_smooth_signal(std::size_t side, std::size_t dimension,
                                             float frequency, std::uint64_t seed = 5) {
  const auto waves = random_values(3 * dimension, seed);
  std::vector<float> signal;
  for (std::size_t p = 0; p < side * side; ++p) {
    const float u = static_cast<float>(p % side) / static_cast<float>(side);
    const float v = static_cast<float>(p / side) / static_cast<float>(side);
    for (std::size_t i = 0; i < dimension; ++i) {
      const float* wave = &waves[3 * i];
      signal.push_back(std::sin(frequency * (wave[0] * u + wave[1] * v) + 6.0f * wave[2]));
    }
  }
  return signal;
}

/// Four signals of groups of falling strength after each other: some clusters need more vectors.
inline std::vector<float> make_uneven_signal(std::size_t point_count, std::size_t dimension,
                                             std::size_t group_count) {
  std::vector<float> signal;
  for (std::uint64_t part = 0; part < 4; ++part) {
    for (float value : make_signal(point_count / 4, dimension, group_count, 100 * part)) {
      signal.push_back(value / static_cast<float>(1 + part * part));
    }
  }
  return signal;
}

/// Signals of nine coefficients that the options below approximate exactly.
struct DegenerateCase {
  const char* name;
  std::vector<float> signal;
  Options options;
};

inline std::vector<DegenerateCase> degenerate_cases() {
  constexpr std::size_t n = 9;
  const std::vector<float> constant(50 * n, 0.1f);
  std::vector<float> rank_one, duplicated;
  const auto direction = random_values(n, 1);
  for (std::size_t p = 0; p < 50; ++p) {
    for (std::size_t i = 0; i < n; ++i) {
      rank_one.push_back(0.3f + static_cast<float>(p) * direction[i]);
      duplicated.push_back(static_cast<float>(p % 3) * direction[i]);
    }
  }
  const std::vector<float> one_point(constant.begin(), constant.begin() + n);
  return {{"constant", constant, {.cluster_count = 1, .component_count = 2}},
          {"constant", constant, {.cluster_count = 5, .component_count = 2}},
          {"constant, a cluster a point", constant, {.cluster_count = 50, .component_count = 0}},
          {"zero", std::vector<float>(50 * n), {.cluster_count = 3, .component_count = 2}},
          {"rank one", rank_one, {.cluster_count = 1, .component_count = 1}},
          {"rank one", rank_one, {.cluster_count = 4, .component_count = 3}},
          {"duplicated", duplicated, {.cluster_count = 3, .component_count = 0}},
          {"duplicated", duplicated, {.cluster_count = 20, .component_count = 2}},
          {"one point", one_point, {.cluster_count = 1, .component_count = 3}}};
}

}  // namespace prt::cpca
