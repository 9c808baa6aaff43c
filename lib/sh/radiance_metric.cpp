#include "sh/radiance_metric.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "linalg/decompose.h"
#include "linalg/product.h"
#include "sh/hemisphere.h"

namespace prt::sh {

namespace {

using linalg::ConstMatrixF;
using linalg::MatrixF;
using linalg::Transpose;

constexpr std::size_t kMatrixBlock = 64;
/// Errors of what the hemisphere hardly shows still count as if it showed this much (squared): such
/// coefficients stay moderate, as they are seen where normals are interpolated.
constexpr double kLeastVisible = 1e-3;

/// Σ_e f(λ_e) u_e u_eᵀ.
std::vector<float> function_of(const linalg::Eigenpairs& pairs, double (*f)(double)) {
  const std::size_t n = pairs.values.size();
  std::vector<float> result(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      double sum = 0.0;
      for (std::size_t e = 0; e < n; ++e) {
        sum += f(std::max(pairs.values[e], kLeastVisible)) * pairs.vectors[e * n + i] *
               pairs.vectors[e * n + k];
      }
      result[i * n + k] = static_cast<float>(sum);
    }
  }
  return result;
}

}  // namespace

RadianceMetric::RadianceMetric(int row_count, std::size_t column_count)
    : row_count_(static_cast<std::size_t>(row_count)), column_count_(column_count) {
  if (changes_nothing()) return;
  const std::vector<int> functions = hemisphere_functions(row_count);
  std::vector<double> gram = hemisphere_gram(functions, functions);
  const auto pairs =
      linalg::largest_eigenpairs(linalg::MatrixD(gram.data(), row_count_, row_count_), row_count_);
  root_ = function_of(pairs, [](double value) { return std::sqrt(value); });
  inverse_root_ = function_of(pairs, [](double value) { return 1.0 / std::sqrt(value); });
}

void RadianceMetric::multiply(const std::vector<float>& matrix, std::span<float> rows) const {
  if (changes_nothing()) return;
  const std::size_t size = row_count_ * column_count_;
  parallel_for(rows.size() / size, kMatrixBlock, [&](std::size_t begin, std::size_t end) {
    std::vector<float> from(size);
    for (std::size_t i = begin; i < end; ++i) {
      float* const to = &rows[i * size];
      std::copy_n(to, size, from.begin());
      linalg::gemm(1.0f, ConstMatrixF(matrix.data(), row_count_, row_count_), Transpose::no,
                   ConstMatrixF(from.data(), row_count_, column_count_), Transpose::no, 0.0f,
                   MatrixF(to, row_count_, column_count_));
    }
  });
}

}  // namespace prt::sh
