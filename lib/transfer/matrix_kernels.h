// Inner loops of transfer matrices, compiled for each level of core/cpu.h.
#pragma once

#include <cstddef>
#include <cstdint>

namespace prt::transfer {

/// Columns of products come in whole groups of so many floats.
constexpr std::size_t kProductPadding = 16;

constexpr std::size_t padded_columns(std::size_t count) {
  return (count + kProductPadding - 1) / kProductPadding * kProductPadding;
}

/// C += Aᵀ B of small matrices, some tens wide, for which a BLAS spends its time on packing:
///   c[i · c_stride + j] += Σ_k a[k · a_stride + i] · b[k · b_stride + j]
/// for i < row_count, k < depth and j < column_count, a multiple of kProductPadding. Nothing
/// overlaps c.
struct SmallProduct {
  const float* a;
  std::size_t a_stride;
  const float* b;
  std::size_t b_stride;
  float* c;
  std::size_t c_stride;
  std::size_t row_count, depth, column_count;
};
void add_product(const SmallProduct& product);

/// Half floats, rounded to the nearest; what overflows becomes the largest one.
void float_to_half(const float* from, std::uint16_t* to, std::size_t count);
void half_to_float(const std::uint16_t* from, float* to, std::size_t count);

}  // namespace prt::transfer
