// Several floats at a time, as GCC's vector types, of one register of each SIMD level. Kernels are
// always-inline templates over the type, instantiated inside one wrapper per level.
#pragma once

#include <cstddef>
#include <cstring>

namespace prt::sh {

using Lanes4 = float __attribute__((vector_size(16)));
using Lanes8 = float __attribute__((vector_size(32)));
using Lanes16 = float __attribute__((vector_size(64)));

template <class Lanes>
constexpr std::size_t kLaneCount = sizeof(Lanes) / sizeof(float);

template <class Lanes>
[[gnu::always_inline]] inline Lanes load(const float* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

template <class Lanes>
[[gnu::always_inline]] inline void store(float* to, const Lanes& lanes) {
  std::memcpy(to, &lanes, sizeof lanes);
}

}  // namespace prt::sh
