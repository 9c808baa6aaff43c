// Matrix products by whatever BLAS is installed. A call runs on the calling thread alone, so that
// parallel_for bodies may make it and results do not depend on the number of threads: split the
// rows of a large product into fixed blocks.
#pragma once

#include <string>

#include "linalg/matrix.h"

namespace prt::linalg {

enum class Transpose { no, yes };

/// C = alpha · op(A) · op(B) + beta · C, where op transposes its matrix or does not. Shapes must
/// fit; nothing may overlap C. With beta = 0, what C held does not matter.
void gemm(float alpha, ConstMatrixF a, Transpose transpose_a, ConstMatrixF b, Transpose transpose_b,
          float beta, MatrixF c);
void gemm(double alpha, ConstMatrixD a, Transpose transpose_a, ConstMatrixD b,
          Transpose transpose_b, double beta, MatrixD c);

/// Name and version of the BLAS in use and of its kernels where it tells, such as
/// "BLIS 0.9.0 (haswell)". Debian's OpenBLAS falls back to slow kernels on processors newer than
/// itself, which this shows.
std::string blas_description();

}  // namespace prt::linalg
