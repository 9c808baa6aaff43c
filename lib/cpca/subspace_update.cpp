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
constexpr std::size_t kBlock = 4096;
/// Variances below this share of the largest are rounding of single precision.
constexpr double kRankTolerance = 1e-7;

void update_mean(const Rows& rows, std::span<const std::uint32_t> points, std::size_t dimension,
                 float* mean) {
  std::vector<double> sums(dimension);
  double total = 0.0;
  for (const std::uint32_t point : points) total += double{rows.weight(point)};
  if (total <= 0.0) return;  // what its points are does not matter
  add_rows(rows, points, sums);
  for (std::size_t i = 0; i < dimension; ++i) mean[i] = static_cast<float>(sums[i] / total);
}

/// Eight partial sums, added up in a fixed order.
double dot(const double* a, const double* b, std::size_t n) {
  double sums[8] = {};
  std::size_t i = 0;
  for (; i + 8 <= n; i += 8) {
    for (std::size_t lane = 0; lane < 8; ++lane) sums[lane] += a[i + lane] * b[i + lane];
  }
  for (; i < n; ++i) sums[0] += a[i] * b[i];
  for (std::size_t lane = 1; lane < 8; ++lane) sums[0] += sums[lane];
  return sums[0];
}

/// Gram-Schmidt. Drops rows that are shorter than `least` then; returns how many are left.
std::size_t orthonormalize(std::vector<double>& rows, std::size_t n, double least) {
  std::size_t kept = 0;
  for (std::size_t v = 0; (v + 1) * n <= rows.size(); ++v) {
    double* row = &rows[kept * n];
    if (kept != v) std::copy_n(&rows[v * n], n, row);
    for (std::size_t u = 0; u < kept; ++u) {
      const double share = dot(row, &rows[u * n], n);
      for (std::size_t i = 0; i < n; ++i) row[i] -= share * rows[u * n + i];
    }
    const double length = std::sqrt(dot(row, row, n));
    if (!(length > least)) continue;
    for (std::size_t i = 0; i < n; ++i) row[i] /= length;
    ++kept;
  }
  return kept;
}

class Update {
 public:
  Update(const Rows& rows, std::span<const std::uint32_t> points, Subspaces& subspaces,
         std::size_t cluster)
      : rows_(rows), points_(points), subspaces_(subspaces), cluster_(cluster) {}

  void step() {
    std::vector<double> product = multiply();
    turn_to_axes(product);
    store(product);
  }

  /// Holds one vector more: towards the point, as far as the others do not reach.
  bool add(std::uint32_t point) {
    const std::size_t n = subspaces_.dimension;
    std::vector<double> rows((held() + 1) * n);
    for (std::size_t v = 0; v < held(); ++v) {
      std::copy_n(subspaces_.vector(cluster_, v), n, &rows[v * n]);
    }
    const float* x = rows_.row(point);
    for (std::size_t i = 0; i < n; ++i) {
      rows[held() * n + i] = double{x[i]} - double{subspaces_.mean(cluster_)[i]};
    }
    const std::uint32_t before = held();
    const double least = 1e-6 * std::sqrt(dot(&rows[before * n], &rows[before * n], n));
    if (orthonormalize(rows, n, least) <= before) return false;
    std::copy_n(&rows[before * n], n, subspaces_.vector(cluster_, before));
    ++subspaces_.held[cluster_];
    return true;
  }

 private:
  std::uint32_t held() const { return subspaces_.held[cluster_]; }

  /// V C.
  std::vector<double> multiply() {
    const std::size_t size = held() * subspaces_.stride,
                      blocks = block_count(points_.size(), kBlock);
    std::vector<double> products(blocks * size);
    parallel_for(points_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
      multiply_by_covariance(rows_, subspaces_, {cluster_, points_.subspan(begin, end - begin)},
                             held(), std::span(products).subspan(begin / kBlock * size, size));
    });
    for (std::size_t b = 1; b < blocks; ++b) {
      for (std::size_t i = 0; i < size; ++i) products[i] += products[b * size + i];
    }
    const std::size_t n = subspaces_.dimension;
    std::vector<double> product(held() * n);
    for (std::size_t v = 0; v < held(); ++v) {
      std::copy_n(&products[v * subspaces_.stride], n, &product[v * n]);
    }
    return product;
  }

  /// From V C to U V C, where the rows of U are the eigenvectors of V C V^T.
  void turn_to_axes(std::vector<double>& product) {
    const std::size_t n = subspaces_.dimension, count = held();
    std::vector<double> inner(count * count), vector(n), turned(count * n);
    for (std::size_t j = 0; j < count; ++j) {
      std::copy_n(subspaces_.vector(cluster_, j), n, vector.begin());
      for (std::size_t i = 0; i <= j; ++i)
        inner[i * count + j] = dot(&product[i * n], vector.data(), n);
    }
    const auto pairs =
        linalg::largest_eigenpairs(linalg::MatrixD{inner.data(), count, count}, count);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) {
        const double share = pairs.vectors[i * count + j];
        for (std::size_t d = 0; d < n; ++d) turned[i * n + d] += share * product[j * n + d];
      }
      subspaces_.variances[cluster_ * subspaces_.capacity + i] = pairs.values[i];
    }
    product = std::move(turned);
  }

  void store(std::vector<double>& product) {
    const std::size_t n = subspaces_.dimension;
    const std::size_t kept = orthonormalize(
        product, n, kRankTolerance * subspaces_.variances[cluster_ * subspaces_.capacity]);
    for (std::size_t v = 0; v < kept; ++v) {
      std::transform(&product[v * n], &product[v * n] + n, subspaces_.vector(cluster_, v),
                     [](double value) { return static_cast<float>(value); });
    }
    subspaces_.held[cluster_] = static_cast<std::uint32_t>(kept);
  }

  const Rows& rows_;
  std::span<const std::uint32_t> points_;
  Subspaces& subspaces_;
  std::size_t cluster_;
};

}  // namespace

void update_subspace(const Rows& rows, std::span<const std::uint32_t> points,
                     std::span<const float> errors, Subspaces& subspaces, std::size_t cluster,
                     const UpdateOptions& options) {
  if (points.empty()) return;
  update_mean(rows, points, subspaces.dimension, subspaces.mean(cluster));
  Update update(rows, points, subspaces, cluster);
  std::uint32_t& held = subspaces.held[cluster];
  const auto most = static_cast<std::uint32_t>(
      std::min<std::size_t>({options.held, points.size() - 1, subspaces.dimension}));
  held = std::min(held, most);
  if (held < most) {
    std::vector<std::uint32_t> worst(points.begin(), points.end());
    const auto middle = worst.begin() + std::min<std::ptrdiff_t>(most - held, std::ssize(worst));
    std::partial_sort(worst.begin(), middle, worst.end(), [&](std::uint32_t a, std::uint32_t b) {
      const float x = rows.weight(a) * errors[a], y = rows.weight(b) * errors[b];
      return x != y ? x > y : a < b;
    });
    for (auto point = worst.begin(); point != middle; ++point) update.add(*point);
  }
  for (int step = 0; step < options.steps && held > 0; ++step) update.step();
  subspaces.used[cluster] = std::min(options.used, held);
}

}  // namespace prt::cpca
