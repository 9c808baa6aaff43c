// What the kernels of iterative encoders share: points as panels of registers, and products with
// them. Nearly all of it is always inlined into run_for(), which compiles it for each instruction
// set.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <utility>

#include "core/cpu.h"
#include "cpca/subspaces.h"

namespace prt::cpca {

/// A register tile: kRows vectors × two registers of points.
template <int Bytes, int Rows>
struct Tile {
  static constexpr int kLanes = Bytes / 4, kPanel = 2 * kLanes, kRows = Rows;
  using Floats [[gnu::vector_size(Bytes), gnu::may_alias]] = float;
  using Unaligned [[gnu::vector_size(Bytes), gnu::may_alias, gnu::aligned(4)]] = float;
  using Ints [[gnu::vector_size(Bytes), gnu::may_alias]] = std::int32_t;
  using Shorts [[gnu::vector_size(Bytes / 2)]] = std::int16_t;
};
using TileAvx512 = Tile<64, 14>;
using TileAvx2 = Tile<32, 6>;
using TileBaseline = Tile<16, 6>;

template <class Body>
[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl,avx2,fma")]] auto run_avx512(const Body& body) {
  return body(TileAvx512{});
}
template <class Body>
[[gnu::target("avx2,fma")]] auto run_avx2(const Body& body) {
  return body(TileAvx2{});
}

/// body(tile) with the tile and the instructions of a level. The body must be always inlined, and
/// so must all that it calls and that is to use them.
template <class Body>
auto run_for(SimdLevel level, const Body& body) {
  return level == SimdLevel::avx512 ? run_avx512(body)
         : level == SimdLevel::avx2 ? run_avx2(body)
                                    : body(TileBaseline{});
}

/// Floats on a 64 byte boundary, zero at first.
class Buffer {
 public:
  explicit Buffer(std::size_t count)
      : data_(static_cast<float*>(std::aligned_alloc(64, (count * sizeof(float) + 63) / 64 * 64))) {
    std::memset(data_.get(), 0, count * sizeof(float));
  }
  float* get() { return data_.get(); }

 private:
  struct Free {
    void operator()(float* data) const { std::free(data); }
  };
  std::unique_ptr<float[], Free> data_;
};

/// Rows of floats. What a register holds beyond the end of a row does not count.
class FloatRows {
 public:
  explicit FloatRows(const Rows& rows)
      : values_(rows.values), end_(rows.values + rows.count * rows.stride), stride_(rows.stride) {}

  template <class T>
  [[gnu::always_inline]] typename T::Floats load(std::size_t point, std::size_t d) const {
    const float* from = values_ + point * stride_ + d;
    if (from + T::kLanes <= end_) return *reinterpret_cast<const typename T::Unaligned*>(from);
    typename T::Floats last{};
    for (int lane = 0; from + lane < end_; ++lane) last[lane] = from[lane];
    return last;
  }

 private:
  const float *values_, *end_;
  std::size_t stride_;
};

/// Rows of scaled 16-bit numbers, filled up to padded().
class ShortRows {
 public:
  explicit ShortRows(const Rows& rows)
      : values_(rows.shorts), scales_(rows.scales), stride_(rows.stride) {}

  template <class T>
  [[gnu::always_inline]] typename T::Floats load(std::size_t point, std::size_t d) const {
    typename T::Shorts shorts;
    std::memcpy(&shorts, values_ + point * stride_ + d, sizeof shorts);
    return __builtin_convertvector(shorts, typename T::Floats) *
           *reinterpret_cast<const typename T::Unaligned*>(scales_ + d);
  }

 private:
  const std::int16_t* values_;
  const float* scales_;
  std::size_t stride_;
};

/// Swaps the lanes with bit Step of `a` with those without of `b`.
template <std::size_t Step, class Floats, std::size_t... Lane>
[[gnu::always_inline]] inline void exchange(Floats& a, Floats& b, std::index_sequence<Lane...>) {
  constexpr std::size_t kLanes = sizeof...(Lane);
  const Floats first =
      __builtin_shufflevector(a, b, ((Lane & Step) != 0 ? kLanes + Lane - Step : Lane)...);
  b = __builtin_shufflevector(a, b, ((Lane & Step) != 0 ? kLanes + Lane : Lane + Step)...);
  a = first;
}

/// The sum of all lanes, in pairs.
template <int Step, class Floats, std::size_t... Lane>
[[gnu::always_inline]] inline float sum_lanes(Floats sum, std::index_sequence<Lane...> lanes) {
  if constexpr (Step == 0) {
    return sum[0];
  } else {
    const Floats others = __builtin_shufflevector(sum, sum, (Lane ^ std::size_t{Step})...);
    return sum_lanes<Step / 2>(sum + others, lanes);
  }
}
template <class T>
[[gnu::always_inline]] inline float sum_lanes(typename T::Floats sum) {
  return sum_lanes<T::kLanes / 2>(sum, std::make_index_sequence<T::kLanes>{});
}

/// Transposes a square of registers.
template <std::size_t Lanes, std::size_t Step = 1, class Floats>
[[gnu::always_inline]] inline void transpose_square(Floats (&rows)[Lanes]) {
  if constexpr (Step < Lanes) {
#pragma GCC unroll 16
    for (std::size_t i = 0; i < Lanes; ++i) {
      if ((i & Step) == 0)
        exchange<Step>(rows[i], rows[i + Step], std::make_index_sequence<Lanes>{});
    }
    transpose_square<Lanes, 2 * Step>(rows);
  }
}

/// Up to kPanel points less `origin`, coordinate by coordinate; lanes without a point repeat the
/// last. `panel` holds padded(dimension) × kPanel, `origin` padded(dimension).
template <class T, class Source>
[[gnu::always_inline]] inline void transpose(const Source& source, const float* origin,
                                             std::size_t dimension,
                                             std::span<const std::uint32_t> points, float* panel) {
  constexpr auto kLanes = static_cast<std::size_t>(T::kLanes);
  using Floats = typename T::Floats;
  for (std::size_t half = 0; half < 2; ++half) {
    std::uint32_t point[kLanes];
    for (std::size_t i = 0; i < kLanes; ++i)
      point[i] = points[std::min(half * kLanes + i, points.size() - 1)];
    for (std::size_t d = 0; d < dimension; d += kLanes) {
      const Floats from = *reinterpret_cast<const typename T::Unaligned*>(origin + d);
      Floats rows[kLanes];
#pragma GCC unroll 16
      for (std::size_t i = 0; i < kLanes; ++i)
        rows[i] = source.template load<T>(point[i], d) - from;
      transpose_square(rows);
      auto* to = reinterpret_cast<Floats*>(panel + d * T::kPanel) + half;
#pragma GCC unroll 16
      for (std::size_t i = 0; i < kLanes; ++i) to[2 * i] = rows[i];
    }
  }
}

/// out[r][lane] = Σ_d rows[r][d] panel[d][lane], row_count × kPanel, aligned; each sum is one chain
/// of multiply-adds. One function for each tile, that kernels call (panel_product.cpp).
template <class T>
void multiply(const float* panel, std::size_t panel_stride, const float* rows,
              std::size_t row_stride, std::size_t row_count, std::size_t depth, float* out);
template <>
void multiply<TileAvx512>(const float*, std::size_t, const float*, std::size_t, std::size_t,
                          std::size_t, float*);
template <>
void multiply<TileAvx2>(const float*, std::size_t, const float*, std::size_t, std::size_t,
                        std::size_t, float*);
template <>
void multiply<TileBaseline>(const float*, std::size_t, const float*, std::size_t, std::size_t,
                            std::size_t, float*);

}  // namespace prt::cpca
