#include <cassert>
#include <numeric>

#include "cpca/subspace_kernels.h"
#include "cpca/subspace_tile.h"

namespace prt::cpca {

namespace {

constexpr std::size_t kBlock = 128;

/// Some points of a cluster relative to its mean, and their products with its vectors.
template <class T>
class PointBlock {
 public:
  PointBlock(const Subspaces& subspaces, std::size_t cluster, std::size_t vector_count)
      : subspaces_(subspaces),
        cluster_(cluster),
        vector_count_(vector_count),
        width_(padded(subspaces.dimension)),
        points_(kBlock * width_),
        panel_(width_ * T::kPanel),
        zeros_(width_),
        tile_((1 + vector_count) * T::kPanel),
        shares_((1 + vector_count) * kBlock) {}

  template <class Source>
  [[gnu::always_inline]] void read(const Source& source, const Rows& rows,
                                   std::span<const std::uint32_t> points) {
    count_ = points.size();
    const float* mean = subspaces_.mean(cluster_);
    for (std::size_t p = 0; p < count_; ++p) {
      for (std::size_t d = 0; d < subspaces_.dimension; d += T::kLanes) {
        *reinterpret_cast<typename T::Floats*>(points_.get() + p * width_ + d) =
            source.template load<T>(points[p], d) -
            *reinterpret_cast<const typename T::Unaligned*>(mean + d);
      }
      shares_.get()[p] = rows.weight(points[p]);
    }
  }

  /// b_v·y, times the weight of the point.
  [[gnu::always_inline]] void find_shares() {
    const FloatRows source(Rows{points_.get(), count_, width_});
    std::uint32_t numbers[kBlock];
    std::iota(numbers, numbers + count_, 0u);
    const float* weights = shares_.get();
    for (std::size_t p = 0; p < count_; p += T::kPanel) {
      const std::size_t some = std::min<std::size_t>(T::kPanel, count_ - p);
      transpose<T>(source, zeros_.get(), subspaces_.dimension, {numbers + p, some}, panel_.get());
      multiply<T>(panel_.get(), T::kPanel, subspaces_.vector(cluster_, 0), subspaces_.stride,
                  vector_count_, subspaces_.dimension, tile_.get());
      for (std::size_t v = 0; v < vector_count_; ++v) {
        float* to = shares_.get() + (1 + v) * kBlock + p;
        for (std::size_t i = 0; i < some; ++i)
          to[i] = tile_.get()[v * T::kPanel + i] * weights[p + i];
      }
    }
  }

  /// Σ of the points times their weights, then their shares.
  [[gnu::always_inline]] void add_moments(std::span<double> moments) {
    for (std::size_t d = 0; d < subspaces_.dimension; d += T::kPanel) {
      multiply<T>(points_.get() + d, width_, shares_.get(), kBlock, 1 + vector_count_, count_,
                  tile_.get());
      for (std::size_t v = 0; v <= vector_count_; ++v) {
        double* to = &moments[v * subspaces_.stride + d];
        for (std::size_t i = 0; i < T::kPanel; ++i) to[i] += double{tile_.get()[v * T::kPanel + i]};
      }
    }
  }

 private:
  const Subspaces& subspaces_;
  std::size_t cluster_, vector_count_, width_, count_ = 0;
  Buffer points_, panel_, zeros_, tile_, shares_;
};

template <class T, class Source>
[[gnu::always_inline]] inline void add_all(const Source& source, const Rows& rows,
                                           const Subspaces& subspaces, const ClusterPoints& cluster,
                                           std::size_t vector_count, std::span<double> moments) {
  PointBlock<T> block(subspaces, cluster.number, vector_count);
  for (std::size_t done = 0; done < cluster.points.size(); done += kBlock) {
    block.read(source, rows,
               cluster.points.subspan(done, std::min(kBlock, cluster.points.size() - done)));
    block.find_shares();
    block.add_moments(moments);
  }
}

/// Sums of the coordinates of points in double, each times its weight.
[[gnu::always_inline]] inline void add_all_rows(const Rows& rows,
                                                std::span<const std::uint32_t> points,
                                                std::span<double> sums) {
  for (const std::uint32_t point : points) {
    const float* x = rows.values + point * rows.stride;
    const double weight = rows.weight(point);
    for (std::size_t d = 0; d < sums.size(); ++d) sums[d] += weight * double{x[d]};
  }
}

}  // namespace

void add_moments(const Rows& rows, const Subspaces& subspaces, const ClusterPoints& cluster,
                 std::size_t vector_count, std::span<double> moments, SimdLevel level) {
  run_for(
      level, [&](auto tile) __attribute__((always_inline)) {
        using T = decltype(tile);
        if (rows.values != nullptr) {
          add_all<T>(FloatRows(rows), rows, subspaces, cluster, vector_count, moments);
        } else {
          add_all<T>(ShortRows(rows), rows, subspaces, cluster, vector_count, moments);
        }
      });
}

void add_rows(const Rows& rows, std::span<const std::uint32_t> points, std::span<double> sums,
              SimdLevel level) {
  assert(rows.values != nullptr);
  run_for(
      level, [&](auto) __attribute__((always_inline)) { add_all_rows(rows, points, sums); });
}

}  // namespace prt::cpca
