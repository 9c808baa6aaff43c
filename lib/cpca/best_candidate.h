// The best of the candidates of each point of a panel, in registers: a part of the classification
// (cpca/classify_kernel.cpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cpca/subspace_tile.h"

namespace prt::cpca {

template <class T>
[[gnu::always_inline]] inline bool any_lane(const typename T::Ints& lanes) {
  std::int32_t any = 0;
  for (int lane = 0; lane < T::kLanes; ++lane) any |= lanes[lane];
  return any != 0;
}

/// The best candidate of each point of a panel.
template <class T>
struct Best {
  using Floats = typename T::Floats;
  Floats cost[2], error[2];
  typename T::Ints candidate[2];

  [[gnu::always_inline]] void compare(const Floats* errors, float penalty, const Floats* scales,
                                      const Floats* rounding, std::size_t number) {
    for (int half = 0; half < 2; ++half) {
      const auto other = errors[half] + penalty * scales[half] + rounding[half];
      const auto better = other < cost[half];
      cost[half] = better ? other : cost[half];
      error[half] = better ? errors[half] : error[half];
      candidate[half] =
          better ? typename T::Ints{} + static_cast<std::int32_t>(number) : candidate[half];
    }
  }

  /// Whether errors of at least `bounds` could be better for any point.
  [[gnu::always_inline]] bool may_lose_to(const Floats* bounds, float penalty, const Floats* scales,
                                          const Floats* rounding) const {
    typename T::Ints any{};
    for (int half = 0; half < 2; ++half)
      any |= bounds[half] + penalty * scales[half] - rounding[half] < cost[half];
    return any_lane<T>(any);
  }
};

/// Adds to the affinity of each candidate; `count` lanes hold points.
template <class T>
[[gnu::always_inline]] inline void add_affinities(const float* errors, const Best<T>& best,
                                                  std::size_t count, std::span<float> affinities) {
  using Floats = typename T::Floats;
  constexpr float kTiny = 1e-30f;
  alignas(64) float counts[T::kPanel];
  for (std::size_t p = 0; p < T::kPanel; ++p) counts[p] = p < count ? 1.0f : 0.0f;
  const auto* error = reinterpret_cast<const Floats*>(errors);
  const auto* mask = reinterpret_cast<const Floats*>(counts);
  for (float& affinity : affinities) {
    Floats sum{};
    for (int half = 0; half < 2; ++half) {
      const Floats share = (best.error[half] + kTiny) / (error[half] + kTiny);
      sum += share * share * mask[half];
    }
    for (int lane = 0; lane < T::kLanes; ++lane) affinity += sum[lane];
    error += 2;
  }
}

}  // namespace prt::cpca
