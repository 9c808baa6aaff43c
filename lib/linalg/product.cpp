#include "linalg/product.h"

#include <cassert>
#include <climits>

// Every BLAS has the same C interface, but headers of its own. The weak ones are there only when
// the library is BLIS or OpenBLAS.
extern "C" {
void cblas_sgemm(int order, int transpose_a, int transpose_b, int m, int n, int k, float alpha,
                 const float* a, int lda, const float* b, int ldb, float beta, float* c, int ldc);
void cblas_dgemm(int order, int transpose_a, int transpose_b, int m, int n, int k, double alpha,
                 const double* a, int lda, const double* b, int ldb, double beta, double* c,
                 int ldc);
[[gnu::weak]] void bli_thread_set_num_threads(long count);
[[gnu::weak]] const char* bli_info_get_version_str();
[[gnu::weak]] int bli_arch_query_id();
[[gnu::weak]] const char* bli_arch_string(int id);
[[gnu::weak]] void openblas_set_num_threads(int count);
[[gnu::weak]] const char* openblas_get_corename();
}

namespace prt::linalg {

namespace {

constexpr int kRowMajor = 101, kNoTranspose = 111, kTranspose = 112;

void use_one_thread() {
  [[maybe_unused]] static const bool done = [] {
    if (bli_thread_set_num_threads) bli_thread_set_num_threads(1);
    if (openblas_set_num_threads) openblas_set_num_threads(1);
    return true;
  }();
}

int to_int(std::size_t size) {
  assert(size <= INT_MAX);
  return static_cast<int>(size);
}

template <class T, class Product>
void multiply(Product product, T alpha, MatrixView<const T> a, Transpose transpose_a,
              MatrixView<const T> b, Transpose transpose_b, T beta, MatrixView<T> c) {
  const bool flip_a = transpose_a == Transpose::yes, flip_b = transpose_b == Transpose::yes;
  const std::size_t depth = flip_a ? a.row_count : a.column_count;
  assert((flip_a ? a.column_count : a.row_count) == c.row_count);
  assert((flip_b ? b.row_count : b.column_count) == c.column_count);
  assert((flip_b ? b.column_count : b.row_count) == depth);
  if (c.row_count == 0 || c.column_count == 0) return;
  use_one_thread();
  product(kRowMajor, flip_a ? kTranspose : kNoTranspose, flip_b ? kTranspose : kNoTranspose,
          to_int(c.row_count), to_int(c.column_count), to_int(depth), alpha, a.data,
          to_int(a.stride), b.data, to_int(b.stride), beta, c.data, to_int(c.stride));
}

}  // namespace

void gemm(float alpha, ConstMatrixF a, Transpose transpose_a, ConstMatrixF b, Transpose transpose_b,
          float beta, MatrixF c) {
  multiply(cblas_sgemm, alpha, a, transpose_a, b, transpose_b, beta, c);
}

void gemm(double alpha, ConstMatrixD a, Transpose transpose_a, ConstMatrixD b,
          Transpose transpose_b, double beta, MatrixD c) {
  multiply(cblas_dgemm, alpha, a, transpose_a, b, transpose_b, beta, c);
}

std::string blas_description() {
  if (bli_info_get_version_str && bli_arch_query_id && bli_arch_string) {
    return std::string("BLIS ") + bli_info_get_version_str() + " (" +
           bli_arch_string(bli_arch_query_id()) + ")";
  }
  if (openblas_get_corename) return std::string("OpenBLAS (") + openblas_get_corename() + ")";
  return "BLAS of unknown make";
}

}  // namespace prt::linalg
