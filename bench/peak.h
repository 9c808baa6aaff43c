// What the arithmetic units can do at most: chains of multiply-adds that never leave the registers.
#pragma once

#include <chrono>
#include <cstddef>

#include "core/cpu.h"
#include "core/parallel.h"

namespace prt::bench {

template <int Bytes>
struct Vector {
  using Floats [[gnu::vector_size(Bytes)]] = float;
};

template <int Bytes, int Chains>
[[gnu::always_inline]] inline float multiply_add(std::size_t steps, float factor) {
  using Floats = typename Vector<Bytes>::Floats;
  Floats sums[Chains], factors = Floats{} + factor;
#pragma GCC unroll 32
  for (int c = 0; c < Chains; ++c) sums[c] = Floats{} + static_cast<float>(c);
  for (std::size_t step = 0; step < steps; ++step) {
#pragma GCC unroll 32
    for (int c = 0; c < Chains; ++c) sums[c] = sums[c] * factors + factors;
  }
#pragma GCC unroll 32
  for (int c = 1; c < Chains; ++c) sums[0] += sums[c];
  return sums[0][0];
}

[[gnu::target("avx512f")]] inline float multiply_add_avx512(std::size_t steps, float factor) {
  return multiply_add<64, 24>(steps, factor);
}
[[gnu::target("avx2,fma")]] inline float multiply_add_avx2(std::size_t steps, float factor) {
  return multiply_add<32, 12>(steps, factor);
}
inline float multiply_add_baseline(std::size_t steps, float factor) {
  return multiply_add<16, 12>(steps, factor);
}

/// Peak rate of all threads in floating point operations a second, measured for some 20 ms.
inline double peak_flops() {
  const SimdLevel level = simd_level();
  const auto kernel = level == SimdLevel::avx512 ? multiply_add_avx512
                      : level == SimdLevel::avx2 ? multiply_add_avx2
                                                 : multiply_add_baseline;
  const double lanes = level == SimdLevel::avx512 ? 16 * 24 : level == SimdLevel::avx2 ? 96 : 48;
  constexpr std::size_t kSteps = 20000, kBlocks = 200;
  const auto start = std::chrono::steady_clock::now();
  parallel_for(kBlocks, 1, [&](std::size_t, std::size_t) {
    volatile float result = kernel(kSteps, 0.5f);
    static_cast<void>(result);
  });
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  return 2.0 * lanes * static_cast<double>(kSteps * kBlocks) / elapsed.count();
}

}  // namespace prt::bench
