#include "transfer/kernels.h"

#include "core/cpu.h"

#define PRT_INLINE inline __attribute__((always_inline))

namespace prt::transfer {

namespace {

using Terms = std::span<const WeightedRow>;
using GatherTerms = std::span<const GatherTerm>;

// Eight coefficients at a time over all terms: the partial sum stays in a register.
PRT_INLINE void add_rows_body(Terms terms, const float* rows, std::size_t stride, float* sum) {
  for (std::size_t j = 0; j < stride; j += kRowPadding) {
    float part[kRowPadding] = {};
    for (const WeightedRow& term : terms) {
      const float* row = rows + std::size_t{term.row} * stride + j;
      for (std::size_t i = 0; i < kRowPadding; ++i) part[i] += term.weight * row[i];
    }
    for (std::size_t i = 0; i < kRowPadding; ++i) sum[j + i] += part[i];
  }
}

PRT_INLINE void add_gathered_body(GatherTerms terms, const float* field, std::size_t channels,
                                  std::size_t columns, float* sum) {
  const std::size_t stride = channels * columns;
  for (const GatherTerm& term : terms) {
    const float* a = field + term.corners[0] * stride;
    const float* b = field + term.corners[1] * stride;
    const float* c = field + term.corners[2] * stride;
    for (std::size_t channel = 0; channel < channels; ++channel) {
      const float wa = term.weights[channel] * term.barycentric[0];
      const float wb = term.weights[channel] * term.barycentric[1];
      const float wc = term.weights[channel] * term.barycentric[2];
      const std::size_t first = channel * columns;
      for (std::size_t j = first; j < first + columns; ++j) {
        sum[j] += wa * a[j] + wb * b[j] + wc * c[j];
      }
    }
  }
}

PRTKIT_AVX512 void add_rows_avx512(Terms terms, const float* rows, std::size_t stride, float* sum) {
  add_rows_body(terms, rows, stride, sum);
}
PRTKIT_AVX2 void add_rows_avx2(Terms terms, const float* rows, std::size_t stride, float* sum) {
  add_rows_body(terms, rows, stride, sum);
}
PRTKIT_AVX512 void add_gathered_avx512(GatherTerms terms, const float* field, std::size_t channels,
                                       std::size_t columns, float* sum) {
  add_gathered_body(terms, field, channels, columns, sum);
}
PRTKIT_AVX2 void add_gathered_avx2(GatherTerms terms, const float* field, std::size_t channels,
                                   std::size_t columns, float* sum) {
  add_gathered_body(terms, field, channels, columns, sum);
}

}  // namespace

void add_weighted_rows(Terms terms, const float* rows, std::size_t stride, float* sum) {
  kernel_for(simd_level(), add_rows_avx512, add_rows_avx2, add_rows_body)(terms, rows, stride, sum);
}

void add_gathered(GatherTerms terms, const float* field, std::size_t channels, std::size_t columns,
                  float* sum) {
  kernel_for(simd_level(), add_gathered_avx512, add_gathered_avx2, add_gathered_body)(
      terms, field, channels, columns, sum);
}

}  // namespace prt::transfer
