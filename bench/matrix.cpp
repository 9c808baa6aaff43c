// The small products of transfer matrices (lib/transfer/matrix_kernels.h) beside the same by the
// installed BLAS, the large one, which is the BLAS's, SGEMM of large matrices and the peak of the
// arithmetic units, all threads:
//   bench_matrix
// Best of several runs, interleaved, since other load comes and goes.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "linalg/product.h"
#include "peak.h"
#include "transfer/matrix_kernels.h"
#include "transfer/reflection.h"

namespace {

using namespace prt;
using linalg::ConstMatrixF;
using linalg::MatrixF;
using linalg::Transpose;

constexpr int kRepetitions = 7;
constexpr double kFlops = 4e9;  // of a run

/// Operands of one thread.
struct Operands {
  Operands(std::size_t rows, std::size_t depth, std::size_t columns)
      : a(rows * depth, 0.5f), b(depth * columns, 0.25f), c(rows * columns) {}
  std::vector<float> a, b, c;
};

struct Kernel {
  std::string name;
  std::size_t row_count, depth, column_count;
  bool blas;
  double best = 0;  ///< flops a second

  void run() {
    const double flops = 2.0 * static_cast<double>(row_count * depth * column_count);
    const auto count = std::max<std::size_t>(1, static_cast<std::size_t>(kFlops / flops));
    const auto threads = static_cast<std::size_t>(thread_count());
    const Stopwatch watch;
    parallel_for(threads, 1, [&](std::size_t, std::size_t) {
      Operands on(row_count, depth, column_count);
      for (std::size_t i = 0; i < count; ++i) multiply(on);
    });
    best = std::max(best, flops * static_cast<double>(count * threads) / watch.seconds());
  }

  void multiply(Operands& on) const {
    if (blas) {
      linalg::gemm(1.0f, ConstMatrixF(on.a.data(), depth, row_count), Transpose::yes,
                   ConstMatrixF(on.b.data(), depth, column_count), Transpose::no, 1.0f,
                   MatrixF(on.c.data(), row_count, column_count));
    } else {
      transfer::add_product({on.a.data(), row_count, on.b.data(), column_count, on.c.data(),
                             column_count, row_count, depth, column_count});
    }
  }
};

}  // namespace

int main() {
  // Shapes of 25 rows, 25 coefficients and three channels, padded.
  const std::size_t block = transfer::kVertexBlock;
  std::vector<Kernel> kernels{{"SGEMM 1024 x 1024 x 1024", 1024, 1024, 1024, true}};
  const auto add = [&](const char* name, std::size_t rows, std::size_t depth, std::size_t columns) {
    kernels.push_back(
        {fmt::format("{} {} x {} x {}", name, rows, depth, columns), rows, depth, columns, false});
    kernels.push_back({"  by BLAS", rows, depth, columns, true});
  };
  kernels.push_back(
      {fmt::format("visibility, triple products {} x 81 x 625", block), block, 81, 625, true});
  add("directions of 1024 corners", 25, 25, 1024);
  add("what a corner sends to 4", 4, 25, 80);
  add("what a corner sends to 16", 16, 25, 80);
  add("moments of 150 directions", 25, 150, 80);
  add("a BRDF's operator", 25, 25, 32);
  double peak = 0;
  for (int i = 0; i < kRepetitions; ++i) {
    peak = std::max(peak, bench::peak_flops());
    for (Kernel& kernel : kernels) kernel.run();
  }
  fmt::print("{}, {} threads\n", linalg::blas_description(), thread_count());
  fmt::print("{:44} {:6.1f} GFLOP/s\n", "peak of the arithmetic units", 1e-9 * peak);
  for (const Kernel& kernel : kernels) {
    fmt::print("{:44} {:6.1f} GFLOP/s, {:3.0f}% of SGEMM\n", kernel.name, 1e-9 * kernel.best,
               100 * kernel.best / kernels[0].best);
  }
}
