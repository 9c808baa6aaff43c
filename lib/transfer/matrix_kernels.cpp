#include "transfer/matrix_kernels.h"

#include <half.h>
#include <immintrin.h>

#include <algorithm>

#include "core/cpu.h"
#include "sh/lanes.h"

#define PRT_INLINE inline __attribute__((always_inline))

namespace prt::transfer {

namespace {

constexpr float kLargestHalf = 65504.0f;

// Rows × Width registers of C, which stay there while k runs.
template <class Lanes, int Rows, int Width>
PRT_INLINE void add_tile(const SmallProduct& p, std::size_t row, std::size_t column) {
  constexpr std::size_t kLanes = sh::kLaneCount<Lanes>;
  Lanes sums[Rows][Width];
#pragma GCC unroll 8
  for (int i = 0; i < Rows; ++i) {
#pragma GCC unroll 8
    for (int w = 0; w < Width; ++w) {
      sums[i][w] = sh::load<Lanes>(p.c + (row + static_cast<std::size_t>(i)) * p.c_stride + column +
                                   static_cast<std::size_t>(w) * kLanes);
    }
  }
  const float* a = p.a + row;
  const float* b = p.b + column;
  for (std::size_t k = 0; k < p.depth; ++k, a += p.a_stride, b += p.b_stride) {
#pragma GCC unroll 8
    for (int w = 0; w < Width; ++w) {
      const Lanes factor = sh::load<Lanes>(b + static_cast<std::size_t>(w) * kLanes);
#pragma GCC unroll 8
      for (int i = 0; i < Rows; ++i) sums[i][w] += a[i] * factor;
    }
  }
#pragma GCC unroll 8
  for (int i = 0; i < Rows; ++i) {
#pragma GCC unroll 8
    for (int w = 0; w < Width; ++w) {
      sh::store(p.c + (row + static_cast<std::size_t>(i)) * p.c_stride + column +
                    static_cast<std::size_t>(w) * kLanes,
                sums[i][w]);
    }
  }
}

template <class Lanes, int Width>
PRT_INLINE void add_columns(const SmallProduct& p, std::size_t column) {
  std::size_t row = 0;
  for (; row + 4 <= p.row_count; row += 4) add_tile<Lanes, 4, Width>(p, row, column);
  switch (p.row_count - row) {
    case 3:
      return add_tile<Lanes, 3, Width>(p, row, column);
    case 2:
      return add_tile<Lanes, 2, Width>(p, row, column);
    case 1:
      return add_tile<Lanes, 1, Width>(p, row, column);
    default:
      return;
  }
}

template <class Lanes>
PRT_INLINE void add_all(const SmallProduct& p) {
  constexpr std::size_t kLanes = sh::kLaneCount<Lanes>;
  std::size_t column = 0;
  for (; column + 2 * kLanes <= p.column_count; column += 2 * kLanes) {
    add_columns<Lanes, 2>(p, column);
  }
  if (column < p.column_count) add_columns<Lanes, 1>(p, column);
}

PRTKIT_AVX512 void add_product_avx512(const SmallProduct& p) { add_all<sh::Lanes16>(p); }
PRTKIT_AVX2 void add_product_avx2(const SmallProduct& p) { add_all<sh::Lanes8>(p); }

void float_to_half_plain(const float* from, std::uint16_t* to, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    to[i] = half(std::clamp(from[i], -kLargestHalf, kLargestHalf)).bits();
  }
}

void half_to_float_plain(const std::uint16_t* from, float* to, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) to[i] = half(half::FromBits, from[i]);
}

// Processors with AVX2 that have no conversions of half floats were never made, but virtual
// machines may hide them.
#define PRT_HALF __attribute__((target("avx,f16c")))

PRT_HALF void float_to_half_vectors(const float* from, std::uint16_t* to, std::size_t count) {
  const __m256 high = _mm256_set1_ps(kLargestHalf), low = _mm256_set1_ps(-kLargestHalf);
  for (std::size_t i = 0; i < count; i += 8) {
    const __m256 value = _mm256_max_ps(low, _mm256_min_ps(high, _mm256_loadu_ps(from + i)));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to + i),
                     _mm256_cvtps_ph(value, _MM_FROUND_TO_NEAREST_INT));
  }
}

PRT_HALF void half_to_float_vectors(const std::uint16_t* from, float* to, std::size_t count) {
  for (std::size_t i = 0; i < count; i += 8) {
    const __m128i bits = _mm_loadu_si128(reinterpret_cast<const __m128i*>(from + i));
    _mm256_storeu_ps(to + i, _mm256_cvtph_ps(bits));
  }
}

bool has_half_vectors() {
  static const bool has =
      simd_level() != SimdLevel::baseline && __builtin_cpu_supports("f16c") != 0;
  return has;
}

}  // namespace

void float_to_half(const float* from, std::uint16_t* to, std::size_t count) {
  const std::size_t whole = has_half_vectors() ? count / 8 * 8 : 0;
  if (whole > 0) float_to_half_vectors(from, to, whole);
  float_to_half_plain(from + whole, to + whole, count - whole);
}

void half_to_float(const std::uint16_t* from, float* to, std::size_t count) {
  const std::size_t whole = has_half_vectors() ? count / 8 * 8 : 0;
  if (whole > 0) half_to_float_vectors(from, to, whole);
  half_to_float_plain(from + whole, to + whole, count - whole);
}

void add_product(const SmallProduct& product) {
  kernel_for(simd_level(), add_product_avx512, add_product_avx2, add_all<sh::Lanes4>)(product);
}

}  // namespace prt::transfer
