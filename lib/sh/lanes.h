// Sixteen floats at a time, as GCC's vector type: one zmm register, two ymm or four xmm. Kernels
// are always-inline bodies over Lanes, instantiated inside one wrapper per SIMD level.
#pragma once

#include <cstddef>
#include <cstring>

namespace prt::sh {

constexpr std::size_t kLaneCount = 16;
using Lanes = float __attribute__((vector_size(kLaneCount * sizeof(float))));

[[gnu::always_inline]] inline Lanes load(const float* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

[[gnu::always_inline]] inline void store(float* to, const Lanes& lanes) {
  std::memcpy(to, &lanes, sizeof lanes);
}

/// The target attributes of the wrappers.
#define PRTKIT_AVX512 __attribute__((target("avx512f,avx512bw,avx512dq,avx512vl,avx2,fma")))
#define PRTKIT_AVX2 __attribute__((target("avx2,fma")))

}  // namespace prt::sh
