#include "cpca/subspace_kernels.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

namespace prt::cpca {

namespace {

/// A register tile: kRows vectors × two registers of points.
template <int Bytes, int Rows>
struct Tile {
  static constexpr int kLanes = Bytes / 4, kPanel = 2 * kLanes, kRows = Rows;
  using Floats [[gnu::vector_size(Bytes), gnu::may_alias]] = float;
  using Unaligned [[gnu::vector_size(Bytes), gnu::may_alias, gnu::aligned(4)]] = float;
  using Ints [[gnu::vector_size(Bytes), gnu::may_alias]] = std::int32_t;
};
using TileAvx512 = Tile<64, 14>;
using TileAvx2 = Tile<32, 6>;
using TileBaseline = Tile<16, 6>;

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

/// out[r][lane] = Σ_d rows[r][d] panel[d][lane], each one chain of multiply-adds.
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

/// Any number of rows; out is row_count × kPanel, aligned.
template <class T, int Rows = T::kRows>
[[gnu::always_inline]] inline void multiply(const float* panel, std::size_t panel_stride,
                                            const float* rows, std::size_t row_stride,
                                            std::size_t row_count, std::size_t depth, float* out) {
  while (row_count >= Rows) {
    multiply_tile<T, Rows>(panel, panel_stride, rows, row_stride, depth, out);
    rows += Rows * row_stride;
    out += Rows * T::kPanel;
    row_count -= Rows;
  }
  if constexpr (Rows > 1) {
    if (row_count > 0) {
      multiply<T, Rows - 1>(panel, panel_stride, rows, row_stride, row_count, depth, out);
    }
  }
}

/// Up to kPanel points less `origin`, coordinate by coordinate; lanes without a point repeat the
/// last.
template <class T>
[[gnu::always_inline]] inline void transpose(const Rows& rows, const float* origin,
                                             std::size_t dimension,
                                             std::span<const std::uint32_t> points, float* panel) {
  const float* row[T::kPanel];
  for (std::size_t p = 0; p < T::kPanel; ++p)
    row[p] = rows.row(points[std::min(p, points.size() - 1)]);
  for (std::size_t d = 0; d < dimension; ++d) {
    for (std::size_t p = 0; p < T::kPanel; ++p) panel[d * T::kPanel + p] = row[p][d] - origin[d];
  }
}

/// Σ (a - b) c
template <class T>
[[gnu::always_inline]] inline float dot_difference(const float* a, const float* b, const float* c,
                                                   std::size_t count) {
  using Floats = typename T::Floats;
  using Unaligned = typename T::Unaligned;
  Floats sum{};
  for (std::size_t i = 0; i < count; i += T::kLanes) {
    sum +=
        (*reinterpret_cast<const Unaligned*>(a + i) - *reinterpret_cast<const Unaligned*>(b + i)) *
        *reinterpret_cast<const Unaligned*>(c + i);
  }
  float total = 0.0f;
  for (int lane = 0; lane < T::kLanes; ++lane) total += sum[lane];
  return total;
}

/// For each candidate ‖d‖², then d·b_i of its vectors.
template <class T>
[[gnu::always_inline]] inline void find_offsets(const Subspaces& subspaces,
                                                std::span<const std::uint32_t> candidates,
                                                float* offsets) {
  const std::size_t count = padded(subspaces.dimension);
  const float* own = subspaces.mean(candidates[0]);
  for (const std::uint32_t k : candidates) {
    const float* mean = subspaces.mean(k);
    float square = 0.0f;
    square = dot_difference<T>(mean, own, mean, count) - dot_difference<T>(mean, own, own, count);
    *offsets++ = std::max(0.0f, square);
    for (std::uint32_t i = 0; i < subspaces.used[k]; ++i) {
      *offsets++ = dot_difference<T>(mean, own, subspaces.vector(k, i), count);
    }
  }
}

/// The best candidate of each point of a panel.
template <class T>
struct Best {
  typename T::Floats cost[2], error[2];
  typename T::Ints candidate[2];
};

/// What is lost to rounding in errors, as a share of the squares that they come from.
constexpr float kRounding = 1e-6f;

template <class T>
[[gnu::always_inline]] inline void compare(const float* errors, float penalty, const float* scales,
                                           std::size_t candidate, Best<T>& best) {
  const auto* error = reinterpret_cast<const typename T::Floats*>(errors);
  const auto* scale = reinterpret_cast<const typename T::Floats*>(scales);
  for (int half = 0; half < 2; ++half) {
    const auto cost = error[half] + penalty * scale[half];
    const auto better = cost < best.cost[half];
    best.cost[half] = better ? cost : best.cost[half];
    best.error[half] = better ? error[half] : best.error[half];
    best.candidate[half] =
        better ? typename T::Ints{} + static_cast<std::int32_t>(candidate) : best.candidate[half];
  }
}

/// Errors of a panel in each candidate (candidate × kPanel), and the best of each point.
template <class T>
[[gnu::always_inline]] inline void find_errors(const Subspaces& subspaces,
                                               const Classification& work, const float* offsets,
                                               const float* panel, const float* scales,
                                               float* products, float* errors, Best<T>& best) {
  using Floats = typename T::Floats;
  const std::size_t n = subspaces.dimension;
  const auto* y = reinterpret_cast<const Floats*>(panel);
  const auto* scale = reinterpret_cast<const Floats*>(scales);
  Floats square[2] = {}, own[2] = {};
  for (std::size_t d = 0; d < n; ++d) {
    square[0] += y[2 * d] * y[2 * d];
    square[1] += y[2 * d + 1] * y[2 * d + 1];
  }
  for (std::size_t c = 0; c < work.candidates.size(); ++c, errors += T::kPanel) {
    const std::uint32_t k = work.candidates[c];
    const std::size_t count = subspaces.used[k];
    multiply<T>(panel, T::kPanel, subspaces.mean(k), subspaces.stride, 1 + count, n, products);
    const auto* product = reinterpret_cast<const Floats*>(products);
    auto* error = reinterpret_cast<Floats*>(errors);
    for (std::size_t half = 0; half < 2; ++half) {
      if (c == 0) own[half] = product[half];
      Floats sum = square[half] - 2.0f * (product[half] - own[half]) + offsets[0];
      for (std::size_t i = 1; i <= count; ++i) {
        const Floats share = product[2 * i + half] - offsets[i];
        sum -= share * share;
      }
      error[half] = sum > 0.0f ? sum : Floats{};
    }
    offsets += 1 + count;
    const float penalty = work.penalties[c];
    if (c > 0) {
      compare<T>(errors, penalty, scales, c, best);
      continue;
    }
    for (int half = 0; half < 2; ++half) {
      best.error[half] = error[half];
      best.cost[half] = error[half] + penalty * scale[half] - kRounding * square[half];
      best.candidate[half] = typename T::Ints{};
    }
  }
}

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

template <class T>
[[gnu::always_inline]] inline double classify_all(const Rows& rows, const Subspaces& subspaces,
                                                  const Classification& work) {
  const std::size_t n = subspaces.dimension;
  std::size_t offset_count = 0, most = 0;
  for (const std::uint32_t k : work.candidates) {
    offset_count += 1 + subspaces.used[k];
    most = std::max<std::size_t>(most, 1 + subspaces.used[k]);
  }
  Buffer offsets(offset_count), panel(n * T::kPanel), scales(T::kPanel), products(most * T::kPanel),
      errors(work.candidates.size() * T::kPanel);
  find_offsets<T>(subspaces, work.candidates, offsets.get());
  double error_before = 0.0;
  for (std::size_t done = 0; done < work.points.size(); done += T::kPanel) {
    const auto points =
        work.points.subspan(done, std::min<std::size_t>(T::kPanel, work.points.size() - done));
    Best<T> best;
    transpose<T>(rows, subspaces.mean(work.candidates[0]), n, points, panel.get());
    for (std::size_t p = 0; p < T::kPanel; ++p) {
      const float weight = rows.weight(points[std::min(p, points.size() - 1)]);
      scales.get()[p] = weight > 0.0f ? 1.0f / weight : 0.0f;
    }
    find_errors<T>(subspaces, work, offsets.get(), panel.get(), scales.get(), products.get(),
                   errors.get(), best);
    const auto* candidate = reinterpret_cast<const std::int32_t*>(best.candidate);
    const auto* error = reinterpret_cast<const float*>(best.error);
    for (std::size_t p = 0; p < points.size(); ++p) {
      work.labels[points[p]] = work.candidates[static_cast<std::size_t>(candidate[p])];
      work.errors[points[p]] = error[p];
      error_before += double{rows.weight(points[p])} * double{errors.get()[p]};
    }
    if (!work.affinities.empty())
      add_affinities<T>(errors.get(), best, points.size(), work.affinities);
  }
  return error_before;
}

constexpr std::size_t kBlock = 256;

template <class T>
[[gnu::always_inline]] inline void multiply_all(const Rows& rows, const Subspaces& subspaces,
                                                const ClusterPoints& cluster,
                                                std::size_t vector_count,
                                                std::span<double> product) {
  const std::size_t n = subspaces.dimension, width = padded(n);
  const std::span<const std::uint32_t> points = cluster.points;
  const float* mean = subspaces.mean(cluster.number);
  Buffer block(kBlock * width), panel(n * T::kPanel), tile(vector_count * T::kPanel),
      shares(vector_count * kBlock);
  for (std::size_t done = 0; done < points.size(); done += kBlock) {
    const auto some = points.subspan(done, std::min(kBlock, points.size() - done));
    for (std::size_t p = 0; p < some.size(); p += T::kPanel) {
      const std::size_t count = std::min<std::size_t>(T::kPanel, some.size() - p);
      transpose<T>(rows, mean, n, some.subspan(p, count), panel.get());
      multiply<T>(panel.get(), T::kPanel, subspaces.vector(cluster.number, 0), subspaces.stride,
                  vector_count, n, tile.get());
      for (std::size_t v = 0; v < vector_count; ++v) {
        for (std::size_t i = 0; i < count; ++i) {
          shares.get()[v * kBlock + p + i] =
              tile.get()[v * T::kPanel + i] * rows.weight(some[p + i]);
        }
      }
    }
    for (std::size_t p = 0; p < some.size(); ++p) {
      const float* x = rows.row(some[p]);
      float* y = block.get() + p * width;
      for (std::size_t d = 0; d < n; ++d) y[d] = x[d] - mean[d];
    }
    for (std::size_t d = 0; d < n; d += T::kPanel) {
      multiply<T>(block.get() + d, width, shares.get(), kBlock, vector_count, some.size(),
                  tile.get());
      for (std::size_t v = 0; v < vector_count; ++v) {
        for (std::size_t i = 0; i < T::kPanel; ++i) {
          product[v * subspaces.stride + d + i] += double{tile.get()[v * T::kPanel + i]};
        }
      }
    }
  }
}

/// Sums of the coordinates of points in double, each times its weight.
[[gnu::always_inline]] inline void add_all(const Rows& rows, std::span<const std::uint32_t> points,
                                           std::span<double> sums) {
  for (const std::uint32_t point : points) {
    const float* x = rows.row(point);
    const double weight = rows.weight(point);
    for (std::size_t d = 0; d < sums.size(); ++d) sums[d] += weight * double{x[d]};
  }
}

[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl,avx2,fma")]] double classify_avx512(
    const Rows& rows, const Subspaces& subspaces, const Classification& work) {
  return classify_all<TileAvx512>(rows, subspaces, work);
}
[[gnu::target("avx2,fma")]] double classify_avx2(const Rows& rows, const Subspaces& subspaces,
                                                 const Classification& work) {
  return classify_all<TileAvx2>(rows, subspaces, work);
}
double classify_baseline(const Rows& rows, const Subspaces& subspaces, const Classification& work) {
  return classify_all<TileBaseline>(rows, subspaces, work);
}

[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl,avx2,fma")]] void multiply_avx512(
    const Rows& rows, const Subspaces& subspaces, const ClusterPoints& cluster,
    std::size_t vector_count, std::span<double> product) {
  multiply_all<TileAvx512>(rows, subspaces, cluster, vector_count, product);
}
[[gnu::target("avx2,fma")]] void multiply_avx2(const Rows& rows, const Subspaces& subspaces,
                                               const ClusterPoints& cluster,
                                               std::size_t vector_count,
                                               std::span<double> product) {
  multiply_all<TileAvx2>(rows, subspaces, cluster, vector_count, product);
}
void multiply_baseline(const Rows& rows, const Subspaces& subspaces, const ClusterPoints& cluster,
                       std::size_t vector_count, std::span<double> product) {
  multiply_all<TileBaseline>(rows, subspaces, cluster, vector_count, product);
}

[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl,avx2,fma")]] void add_avx512(
    const Rows& rows, std::span<const std::uint32_t> points, std::span<double> sums) {
  add_all(rows, points, sums);
}
[[gnu::target("avx2,fma")]] void add_avx2(const Rows& rows, std::span<const std::uint32_t> points,
                                          std::span<double> sums) {
  add_all(rows, points, sums);
}
void add_baseline(const Rows& rows, std::span<const std::uint32_t> points, std::span<double> sums) {
  add_all(rows, points, sums);
}

}  // namespace

double classify(const Rows& rows, const Subspaces& subspaces, const Classification& classification,
                SimdLevel level) {
  auto* kernel = level == SimdLevel::avx512 ? classify_avx512
                 : level == SimdLevel::avx2 ? classify_avx2
                                            : classify_baseline;
  return kernel(rows, subspaces, classification);
}

void multiply_by_covariance(const Rows& rows, const Subspaces& subspaces,
                            const ClusterPoints& cluster, std::size_t vector_count,
                            std::span<double> product, SimdLevel level) {
  auto* kernel = level == SimdLevel::avx512 ? multiply_avx512
                 : level == SimdLevel::avx2 ? multiply_avx2
                                            : multiply_baseline;
  kernel(rows, subspaces, cluster, vector_count, product);
}

void add_rows(const Rows& rows, std::span<const std::uint32_t> points, std::span<double> sums,
              SimdLevel level) {
  auto* kernel = level == SimdLevel::avx512 ? add_avx512
                 : level == SimdLevel::avx2 ? add_avx2
                                            : add_baseline;
  kernel(rows, points, sums);
}

}  // namespace prt::cpca
