#include "cpca/nearest_mean.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <limits>

namespace prt::cpca {

namespace {

/// A register tile: kRows points × kVectors vectors of kLanes means.
template <int Bytes, int Rows>
struct Tile {
  static constexpr int kLanes = Bytes / 4, kVectors = 2, kRows = Rows;
  static constexpr int kPanel = kLanes * kVectors;
  using Floats [[gnu::vector_size(Bytes), gnu::may_alias]] = float;
  using Ints [[gnu::vector_size(Bytes), gnu::may_alias]] = std::int32_t;
};
using TileAvx512 = Tile<64, 14>;  // 28 of 32 registers
using TileAvx2 = Tile<32, 6>;     // 12 of 16
using TileBaseline = Tile<16, 6>;

/// Best score of every lane and the vector of means it came from, for each point of a tile.
template <class T>
struct Best {
  typename T::Floats score[T::kRows];
  typename T::Ints vector[T::kRows];
};

/// Scores of a tile of points, `stride` floats apart, against one panel of means; the best so far
/// are kept. Few pointers, so that none is spilled in the loop: three rows hang on each. Meanwhile
/// the next tile comes to the cache, `ahead_step` bytes a step from `ahead` on.
template <class T>
[[gnu::always_inline]] inline void multiply_tile(const float* points, std::size_t stride,
                                                 const float* means, const float* biases,
                                                 const char* ahead, std::size_t ahead_step,
                                                 std::int32_t panel, Best<T>* best) {
  using Floats = typename T::Floats;
  const auto* mean = reinterpret_cast<const Floats*>(means);
  const auto* bias = reinterpret_cast<const Floats*>(biases);
  constexpr int kPointers = (T::kRows + 2) / 3, kAhead = 32;
  const float* rows[kPointers];
  Floats sum[T::kRows][2];
#pragma GCC unroll 16
  for (int r = 0; r < kPointers; ++r) rows[r] = points + static_cast<std::size_t>(3 * r) * stride;
#pragma GCC unroll 16
  for (int r = 0; r < T::kRows; ++r) sum[r][0] = bias[0], sum[r][1] = bias[1];
  for (std::size_t i = 0; i < stride; ++i) {
    const Floats first = mean[0], second = mean[1];
    __builtin_prefetch(ahead, 0, 2);  // to the second level
    __builtin_prefetch(mean + kAhead);
    __builtin_prefetch(mean + kAhead + 1);
    ahead += ahead_step;
    mean += 2;
#pragma GCC unroll 16
    for (int r = 0; r < T::kRows; ++r) {
      const float x = rows[r / 3][static_cast<std::size_t>(r % 3) * stride];
      sum[r][0] += first * x;
      sum[r][1] += second * x;
    }
#pragma GCC unroll 16
    for (int r = 0; r < kPointers; ++r) ++rows[r];
  }
  asm("" : "+r"(best));  // stays in memory: registers are for the sums
  const auto first = typename T::Ints{} + 2 * panel, second = first + 1;
#pragma GCC unroll 16
  for (int r = 0; r < T::kRows; ++r) {
    const auto odd = sum[r][1] > sum[r][0];
    const Floats score = odd ? sum[r][1] : sum[r][0];
    const auto better = score > best->score[r];
    best->score[r] = better ? score : best->score[r];
    best->vector[r] = better ? (odd ? second : first) : best->vector[r];
  }
}

/// Label of the greatest score, of equals the lowest label, by halves.
template <int Bytes>
[[gnu::always_inline]] inline std::uint32_t reduce_lanes(
    const typename Tile<Bytes, 1>::Floats& score, const typename Tile<Bytes, 1>::Ints& label) {
  if constexpr (Bytes == 4) {
    return static_cast<std::uint32_t>(label[0]);
  } else {
    using Half = Tile<Bytes / 2, 1>;
    typename Half::Floats scores[2];
    typename Half::Ints labels[2];
    std::memcpy(scores, &score, Bytes);
    std::memcpy(labels, &label, Bytes);
    const auto second =
        (scores[1] > scores[0]) | ((scores[1] == scores[0]) & (labels[1] < labels[0]));
    return reduce_lanes<Bytes / 2>(second ? scores[1] : scores[0], second ? labels[1] : labels[0]);
  }
}

template <class T>
[[gnu::always_inline]] inline void classify_tile(const float* points, std::size_t dimension,
                                                 const float* panels, const float* biases,
                                                 std::size_t panel_count, std::uint32_t* labels) {
  typename T::Ints lane;
  Best<T> best{};
  for (int i = 0; i < T::kLanes; ++i) lane[i] = i;
  for (auto& score : best.score) score -= std::numeric_limits<float>::infinity();
  const std::size_t tile_size = T::kRows * sizeof(float);  // for one coefficient
  const std::size_t ahead_step = (tile_size + panel_count - 1) / panel_count;
  const char* next = reinterpret_cast<const char*>(points) + tile_size * dimension;
  for (std::size_t p = 0; p < panel_count; ++p) {
    multiply_tile<T>(points, dimension, panels + p * dimension * T::kPanel, biases + p * T::kPanel,
                     next + p * dimension * ahead_step, ahead_step, static_cast<std::int32_t>(p),
                     &best);
  }
  for (int r = 0; r < T::kRows; ++r) {
    labels[r] = reduce_lanes<T::kLanes * 4>(best.score[r], best.vector[r] * T::kLanes + lane);
  }
}

/// The last tile overlaps the one before it. Too few points for one tile are copied into one.
template <class T>
[[gnu::always_inline]] inline void classify_points(const float* points, std::size_t count,
                                                   std::size_t dimension, const float* panels,
                                                   const float* biases, std::size_t panel_count,
                                                   std::uint32_t* labels) {
  if (count < T::kRows) {
    std::vector<float> tile(T::kRows * dimension);
    std::uint32_t tile_labels[T::kRows];
    std::copy_n(points, count * dimension, tile.begin());
    classify_tile<T>(tile.data(), dimension, panels, biases, panel_count, tile_labels);
    std::copy_n(tile_labels, count, labels);
    return;
  }
  for (std::size_t done = 0; done < count; done += T::kRows) {
    const std::size_t first = std::min(done, count - T::kRows);
    classify_tile<T>(points + first * dimension, dimension, panels, biases, panel_count,
                     labels + first);
  }
}

[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl,avx2,fma")]] void classify_avx512(
    const float* points, std::size_t count, std::size_t dimension, const float* panels,
    const float* biases, std::size_t panel_count, std::uint32_t* labels) {
  classify_points<TileAvx512>(points, count, dimension, panels, biases, panel_count, labels);
}

[[gnu::target("avx2,fma")]] void classify_avx2(const float* points, std::size_t count,
                                               std::size_t dimension, const float* panels,
                                               const float* biases, std::size_t panel_count,
                                               std::uint32_t* labels) {
  classify_points<TileAvx2>(points, count, dimension, panels, biases, panel_count, labels);
}

void classify_baseline(const float* points, std::size_t count, std::size_t dimension,
                       const float* panels, const float* biases, std::size_t panel_count,
                       std::uint32_t* labels) {
  classify_points<TileBaseline>(points, count, dimension, panels, biases, panel_count, labels);
}

std::size_t panel_width(SimdLevel level) {
  return level == SimdLevel::avx512 ? TileAvx512::kPanel
         : level == SimdLevel::avx2 ? TileAvx2::kPanel
                                    : TileBaseline::kPanel;
}

}  // namespace

NearestMean::NearestMean(std::span<const float> means, std::span<const float> origin,
                         SimdLevel level)
    : level_(level), dimension_(origin.size()) {
  assert(!means.empty() && means.size() % dimension_ == 0);
  const std::size_t mean_count = means.size() / dimension_, width = panel_width(level);
  panel_count_ = (mean_count + width - 1) / width;
  constexpr std::size_t kAlignment = 64 / sizeof(float);
  storage_.resize(panel_count_ * width * (dimension_ + 1) + kAlignment);
  const auto address = reinterpret_cast<std::uintptr_t>(storage_.data()) / sizeof(float);
  biases_ = storage_.data() + (kAlignment - address % kAlignment) % kAlignment;
  panels_ = biases_ + panel_count_ * width;
  // What fills up the last panel never wins.
  std::fill_n(biases_, panel_count_ * width, -std::numeric_limits<float>::infinity());
  for (std::size_t k = 0; k < mean_count; ++k) {
    float* panel = panels_ + k / width * dimension_ * width;
    double half_difference = 0.0;  // (‖c‖² - ‖origin‖²)/2
    for (std::size_t i = 0; i < dimension_; ++i) {
      const double c = means[k * dimension_ + i], o = origin[i];
      panel[i * width + k % width] = static_cast<float>(c - o);
      half_difference += 0.5 * (c - o) * (c + o);
    }
    biases_[k] = static_cast<float>(-half_difference);
  }
}

void NearestMean::classify(std::span<const float> signal, std::size_t begin, std::size_t end,
                           std::span<std::uint32_t> labels) const {
  kernel_for(level_, classify_avx512, classify_avx2, classify_baseline)(
      &signal[begin * dimension_], end - begin, dimension_, panels_, biases_, panel_count_,
      &labels[begin]);
}

}  // namespace prt::cpca
