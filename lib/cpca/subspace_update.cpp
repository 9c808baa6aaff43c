#include "cpca/subspace_update.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "cpca/subspace_kernels.h"
#include "linalg/decompose.h"

namespace prt::cpca {

namespace {

/// Clusters beyond it are worth several threads.
constexpr std::size_t kMomentBlock = 4096;
/// Variances below this share of the largest are rounding: products of points and vectors in single
/// precision make those of the points λ uncertain by 1e-7 √(λ λ_1).
constexpr double kGramTolerance = 1e-10;

class Update {
 public:
  Update(const Rows& rows, std::span<const std::uint32_t> points, Subspaces& subspaces,
         std::size_t cluster)
      : rows_(rows), points_(points), subspaces_(subspaces), cluster_(cluster) {
    for (const std::uint32_t point : points) total_weight_ += double{rows.weight(point)};
  }

  void move_mean() {
    std::vector<double> moments = find_moments(0);
    centre_moments(total_weight_, subspaces_, cluster_, 0, moments, {});
  }

  /// Brings the mean up to the points, and the vectors one step.
  void step() {
    const std::size_t count = held();
    std::vector<double> moments = find_moments(count), inner(count * count);
    centre_moments(total_weight_, subspaces_, cluster_, count, moments, inner);
    if (count == 0) return;
    // The eigenvectors of V C V^T turn V C.
    const auto pairs =
        linalg::largest_eigenpairs(linalg::MatrixD{inner.data(), count, count}, count);
    std::copy(pairs.values.begin(), pairs.values.end(), subspaces_.variances[cluster_].begin());
    subspaces_.held[cluster_] = static_cast<std::uint32_t>(
        turn_vectors(std::span(moments).subspan(subspaces_.stride), pairs.vectors,
                     kGramTolerance * pairs.values[0], subspaces_, cluster_, count));
  }

  /// Holds one vector more: towards the point, as far as the others do not reach.
  bool add(std::uint32_t point) {
    const std::size_t n = subspaces_.dimension;
    std::vector<double> rows((held() + 1) * n);
    for (std::size_t v = 0; v < held(); ++v) {
      std::copy_n(subspaces_.vector(cluster_, v), n, &rows[v * n]);
    }
    double square = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double y = double{rows_.at(point, i)} - double{subspaces_.mean(cluster_)[i]};
      rows[held() * n + i] = y;
      square += y * y;
    }
    const std::uint32_t before = held();
    if (orthonormalize(rows, n, 1e-6 * std::sqrt(square)) <= before) return false;
    std::copy_n(&rows[before * n], n, subspaces_.vector(cluster_, before));
    ++subspaces_.held[cluster_];
    return true;
  }

 private:
  std::uint32_t held() const { return subspaces_.held[cluster_]; }

  std::vector<double> find_moments(std::size_t vector_count) const {
    const std::size_t size = (1 + vector_count) * subspaces_.stride,
                      blocks = block_count(points_.size(), kMomentBlock);
    std::vector<double> moments(blocks * size);
    parallel_for(points_.size(), kMomentBlock, [&](std::size_t begin, std::size_t end) {
      add_moments(rows_, subspaces_, {cluster_, points_.subspan(begin, end - begin)}, vector_count,
                  std::span(moments).subspan(begin / kMomentBlock * size, size));
    });
    for (std::size_t b = 1; b < blocks; ++b) {
      for (std::size_t i = 0; i < size; ++i) moments[i] += moments[b * size + i];
    }
    moments.resize(size);
    return moments;
  }

  const Rows& rows_;
  std::span<const std::uint32_t> points_;
  Subspaces& subspaces_;
  std::size_t cluster_;
  double total_weight_ = 0.0;
};

}  // namespace

void update_subspace(const Rows& rows, std::span<const std::uint32_t> points,
                     std::span<const float> errors, Subspaces& subspaces, std::size_t cluster,
                     const UpdateOptions& options) {
  if (points.empty()) return;
  Update update(rows, points, subspaces, cluster);
  std::uint32_t& held = subspaces.held[cluster];
  const auto most = static_cast<std::uint32_t>(
      std::min<std::size_t>({options.held, points.size() - 1, subspaces.dimension}));
  held = std::min(held, most);
  if (held < most) {
    update.move_mean();
    std::vector<std::uint32_t> worst(points.begin(), points.end());
    const auto middle = worst.begin() + std::min<std::ptrdiff_t>(most - held, std::ssize(worst));
    std::partial_sort(worst.begin(), middle, worst.end(), [&](std::uint32_t a, std::uint32_t b) {
      const float x = rows.weight(a) * errors[a], y = rows.weight(b) * errors[b];
      return x != y ? x > y : a < b;
    });
    for (auto point = worst.begin(); point != middle; ++point) update.add(*point);
  }
  for (int step = 0; step < options.steps; ++step) update.step();
  subspaces.used[cluster] = std::min(options.used, held);
}

}  // namespace prt::cpca
