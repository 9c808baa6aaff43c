#include "cpca/subspace_tile.h"

namespace prt::cpca {

namespace {

/// The same of Rows rows, all of whose sums stay in registers.
template <class T, int Rows>
[[gnu::always_inline]] inline void multiply_tile(const float* panel, std::size_t panel_stride,
                                                 const float* rows, std::size_t row_stride,
                                                 std::size_t depth, float* out) {
  using Floats = typename T::Floats;
  constexpr int kPointers = (Rows + 2) / 3;  // three rows hang on each
  const float* pointers[kPointers];
  Floats sum[Rows][2] = {};
#pragma GCC unroll 16
  for (int r = 0; r < kPointers; ++r)
    pointers[r] = rows + static_cast<std::size_t>(3 * r) * row_stride;
  for (std::size_t d = 0; d < depth; ++d) {
    const Floats first = *reinterpret_cast<const typename T::Unaligned*>(panel);
    const Floats second = *reinterpret_cast<const typename T::Unaligned*>(panel + T::kLanes);
    panel += panel_stride;
#pragma GCC unroll 16
    for (int r = 0; r < Rows; ++r) {
      const float x = pointers[r / 3][static_cast<std::size_t>(r % 3) * row_stride];
      sum[r][0] += first * x;
      sum[r][1] += second * x;
    }
#pragma GCC unroll 16
    for (int r = 0; r < kPointers; ++r) ++pointers[r];
  }
  auto* to = reinterpret_cast<Floats*>(out);
#pragma GCC unroll 16
  for (int r = 0; r < Rows; ++r) to[2 * r] = sum[r][0], to[2 * r + 1] = sum[r][1];
}

template <class T, int Rows = T::kRows>
[[gnu::always_inline]] inline void multiply_rows(const float* panel, std::size_t panel_stride,
                                                 const float* rows, std::size_t row_stride,
                                                 std::size_t row_count, std::size_t depth,
                                                 float* out) {
  while (row_count >= Rows) {
    multiply_tile<T, Rows>(panel, panel_stride, rows, row_stride, depth, out);
    rows += Rows * row_stride;
    out += Rows * T::kPanel;
    row_count -= Rows;
  }
  if constexpr (Rows > 1) {
    if (row_count > 0) {
      multiply_rows<T, Rows - 1>(panel, panel_stride, rows, row_stride, row_count, depth, out);
    }
  }
}

}  // namespace

template <>
[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl,avx2,fma")]] void multiply<TileAvx512>(
    const float* panel, std::size_t panel_stride, const float* rows, std::size_t row_stride,
    std::size_t row_count, std::size_t depth, float* out) {
  multiply_rows<TileAvx512>(panel, panel_stride, rows, row_stride, row_count, depth, out);
}

template <>
[[gnu::target("avx2,fma")]] void multiply<TileAvx2>(const float* panel, std::size_t panel_stride,
                                                    const float* rows, std::size_t row_stride,
                                                    std::size_t row_count, std::size_t depth,
                                                    float* out) {
  multiply_rows<TileAvx2>(panel, panel_stride, rows, row_stride, row_count, depth, out);
}

template <>
void multiply<TileBaseline>(const float* panel, std::size_t panel_stride, const float* rows,
                            std::size_t row_stride, std::size_t row_count, std::size_t depth,
                            float* out) {
  multiply_rows<TileBaseline>(panel, panel_stride, rows, row_stride, row_count, depth, out);
}

}  // namespace prt::cpca
