// Eigenpairs of symmetric matrices and singular values, by LAPACK. Reentrant, on the calling
// thread.
#pragma once

#include <vector>

#include "linalg/matrix.h"

namespace prt::linalg {

struct Eigenpairs {
  std::vector<double> values;   ///< largest first
  std::vector<double> vectors;  ///< one a row, orthonormal; the sign is LAPACK's
};

/// The `count` <= n largest eigenvalues of a symmetric n × n matrix, of which the upper triangle is
/// read and both are overwritten, with their vectors (count × n). [Sloan03] §4.1 saves time in the
/// same way. Throws Error (failed) when LAPACK does not converge, which finite input does not
/// cause.
Eigenpairs largest_eigenpairs(MatrixD symmetric, std::size_t count);

struct Svd {
  std::vector<double> values;  ///< min(m, n), largest first
  std::vector<double> u;       ///< m × min(m, n)
  std::vector<double> vt;      ///< min(m, n) × n
};

/// A = U · diag(values) · V^T of an m × n matrix.
Svd svd(ConstMatrixD a);

}  // namespace prt::linalg
