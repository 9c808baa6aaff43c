#include "cpca/cluster_pca.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "linalg/decompose.h"
#include "linalg/product.h"

namespace prt::cpca {

namespace {

using linalg::Transpose;

/// Points gathered at a time, and columns of C^T C that one task computes.
constexpr std::size_t kPointBlock = 256, kColumnBlock = 64;
/// Clusters from this size on are worth several threads; the others are spread over threads whole.
constexpr std::size_t kLargeCluster = 8192;
/// Eigenvalues below this share of the largest are rounding.
constexpr double kRankTolerance = 1e-12;

/// Rows x_p - mean of some points, times the root of their weight if there are weights.
template <class T>
std::vector<T> gather(std::span<const float> signal, std::span<const std::uint32_t> points,
                      std::span<const float> mean, std::span<const float> point_weights = {}) {
  const std::size_t n = mean.size();
  std::vector<T> rows(points.size() * n);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const float* x = &signal[points[p] * n];
    T* row = &rows[p * n];
    for (std::size_t i = 0; i < n; ++i) row[i] = static_cast<T>(x[i]) - static_cast<T>(mean[i]);
    if (point_weights.empty()) continue;
    const T root = std::sqrt(static_cast<T>(point_weights[points[p]]));
    for (std::size_t i = 0; i < n; ++i) row[i] *= root;
  }
  return rows;
}

/// Upper triangle, in blocks, of C^T C; blocks of points are added in order.
std::vector<double> inner_product(std::span<const float> signal,
                                  std::span<const std::uint32_t> points,
                                  std::span<const float> mean,
                                  std::span<const float> point_weights) {
  const std::size_t n = mean.size();
  std::vector<double> product(n * n);
  const std::size_t column_block = points.size() >= kLargeCluster ? kColumnBlock : n;
  for (std::size_t done = 0; done < points.size(); done += kPointBlock) {
    const auto block = points.subspan(done, std::min(kPointBlock, points.size() - done));
    const std::vector<double> rows = gather<double>(signal, block, mean, point_weights);
    parallel_for(n, column_block, [&](std::size_t begin, std::size_t end) {
      linalg::gemm(1.0, {&rows[begin], block.size(), end - begin, n}, Transpose::yes,
                   {&rows[begin], block.size(), n - begin, n}, Transpose::no, 1.0,
                   {&product[begin * n + begin], end - begin, n - begin, n});
    });
  }
  return product;
}

std::size_t rank(std::span<const double> eigenvalues) {
  std::size_t count = 0;
  while (count < eigenvalues.size() && eigenvalues[count] > kRankTolerance * eigenvalues[0]) {
    ++count;
  }
  return count;
}

/// Right singular vectors of C, row by row, from either normal form.
std::vector<double> components_of_inner(std::span<const float> signal,
                                        std::span<const std::uint32_t> points,
                                        std::span<const float> mean,
                                        std::span<const float> point_weights, std::size_t count) {
  const std::size_t n = mean.size();
  std::vector<double> matrix = inner_product(signal, points, mean, point_weights);
  auto pairs = linalg::largest_eigenpairs(linalg::MatrixD{matrix.data(), n, n}, count);
  pairs.vectors.resize(rank(pairs.values) * n);
  return std::move(pairs.vectors);
}

std::vector<double> components_of_outer(std::span<const float> signal,
                                        std::span<const std::uint32_t> points,
                                        std::span<const float> mean,
                                        std::span<const float> point_weights, std::size_t count) {
  const std::size_t n = mean.size(), m = points.size();
  const std::vector<double> rows = gather<double>(signal, points, mean, point_weights);
  std::vector<double> matrix(m * m);
  linalg::gemm(1.0, {rows.data(), m, n}, Transpose::no, {rows.data(), m, n}, Transpose::yes, 0.0,
               {matrix.data(), m, m});
  auto pairs = linalg::largest_eigenpairs(linalg::MatrixD{matrix.data(), m, m}, count);
  const std::size_t found = rank(pairs.values);
  std::vector<double> vectors(found * n);
  linalg::gemm(1.0, {pairs.vectors.data(), found, m}, Transpose::no, {rows.data(), m, n},
               Transpose::no, 0.0, {vectors.data(), found, n});
  return vectors;  // of length D_i
}

double dot(const double* a, const double* b, std::size_t n) {
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

/// Gram-Schmidt, which only removes rounding here, then unit length and sign.
void orthonormalize(std::vector<double>& vectors, std::size_t n) {
  for (std::size_t v = 0; v * n < vectors.size(); ++v) {
    double* vector = &vectors[v * n];
    for (std::size_t u = 0; u < v; ++u) {
      const double share = dot(vector, &vectors[u * n], n);
      for (std::size_t i = 0; i < n; ++i) vector[i] -= share * vectors[u * n + i];
    }
    const double* largest = std::max_element(
        vector, vector + n, [](double a, double b) { return std::abs(a) < std::abs(b); });
    const double scale = std::copysign(1.0 / std::sqrt(dot(vector, vector, n)), *largest);
    for (std::size_t i = 0; i < n; ++i) vector[i] *= scale;
  }
}

}  // namespace

void find_components(std::span<const float> signal, std::span<const std::uint32_t> points,
                     const Subspace& subspace, std::span<const float> point_weights,
                     NormalForm form) {
  const std::size_t n = subspace.mean.size();
  std::fill(subspace.basis.begin(), subspace.basis.end(), 0.0f);
  const std::size_t count = std::min({subspace.basis.size() / n, n, points.size()});
  if (count == 0) return;
  if (form == NormalForm::smaller) {
    form = points.size() >= n ? NormalForm::inner : NormalForm::outer;
  }
  auto* const components = form == NormalForm::inner ? components_of_inner : components_of_outer;
  std::vector<double> vectors = components(signal, points, subspace.mean, point_weights, count);
  orthonormalize(vectors, n);
  std::transform(vectors.begin(), vectors.end(), subspace.basis.begin(),
                 [](double value) { return static_cast<float>(value); });
}

void project(std::span<const float> signal, std::span<const std::uint32_t> points,
             const Subspace& subspace, std::span<float> weights) {
  const std::size_t n = subspace.mean.size(), count = subspace.basis.size() / n;
  if (count == 0) return;
  parallel_for(points.size(), kPointBlock, [&](std::size_t begin, std::size_t end) {
    const auto block = points.subspan(begin, end - begin);
    const std::vector<float> rows = gather<float>(signal, block, subspace.mean);
    std::vector<float> products(block.size() * count);
    linalg::gemm(1.0f, {rows.data(), block.size(), n}, Transpose::no,
                 {subspace.basis.data(), count, n}, Transpose::yes, 0.0f,
                 {products.data(), block.size(), count});
    for (std::size_t p = 0; p < block.size(); ++p) {
      std::copy_n(&products[p * count], count, &weights[block[p] * count]);
    }
  });
}

}  // namespace prt::cpca
