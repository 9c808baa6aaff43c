#include "linalg/decompose.h"

#include <lapacke.h>

#include <cassert>
#include <opencv2/core.hpp>

#include "core/error.h"

namespace prt::linalg {

namespace {

std::vector<double> elements(const cv::Mat& matrix) {
  return {matrix.ptr<double>(), matrix.ptr<double>() + matrix.total()};
}

}  // namespace

// dsyevr sorts upwards and, asked in column-major order, leaves one vector after the other. A
// symmetric matrix is the same in both orders, except that the triangles change their names.
Eigenpairs largest_eigenpairs(MatrixD symmetric, std::size_t count) {
  const std::size_t n = symmetric.row_count;
  assert(symmetric.column_count == n && count <= n);
  Eigenpairs pairs;
  if (count == 0) return pairs;
  std::vector<double> values(n), vectors(count * n);
  std::vector<lapack_int> support(2 * count);
  lapack_int found = 0;
  const auto size = static_cast<lapack_int>(n);
  const lapack_int first = size - static_cast<lapack_int>(count) + 1;
  const lapack_int info =
      LAPACKE_dsyevr(LAPACK_COL_MAJOR, 'V', 'I', 'L', size, symmetric.data,
                     static_cast<lapack_int>(symmetric.stride), 0.0, 0.0, first, size, 0.0, &found,
                     values.data(), vectors.data(), size, support.data());
  if (info != 0 || found != static_cast<lapack_int>(count)) {
    throw_failed("LAPACK found no eigenpairs of a matrix");
  }
  for (std::size_t i = count; i-- > 0;) {
    pairs.values.push_back(values[i]);
    pairs.vectors.insert(pairs.vectors.end(), &vectors[i * n], &vectors[i * n] + n);
  }
  return pairs;
}

Svd svd(ConstMatrixD a) {
  const cv::Mat matrix(static_cast<int>(a.row_count), static_cast<int>(a.column_count), CV_64F,
                       const_cast<double*>(a.data), a.stride * sizeof(double));
  cv::Mat values, u, vt;
  cv::SVD::compute(matrix, values, u, vt);
  return {elements(values), elements(u), elements(vt)};
}

}  // namespace prt::linalg
