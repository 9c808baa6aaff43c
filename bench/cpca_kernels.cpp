// Rates of the iterative encoder's kernels beside SGEMM of the installed BLAS and beside the peak
// of the arithmetic units in the same run, and how much each computes of the products of all points
// with all means and vectors in use:
//   bench_cpca_kernels [signal.npy [clusters [components]]]
// Without a signal: 50,000 × 600 made up, 256 clusters, 8 components. Times are medians of several,
// interleaved, since other load comes and goes.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "cpca/clusterer.h"
#include "cpca/principal_axes.h"
#include "cpca/seeding.h"
#include "cpca/working_space.h"
#include "linalg/product.h"
#include "made_signal.h"
#include "peak.h"
#include "signal/npy.h"

namespace {

using namespace prt;

constexpr int kRepetitions = 5;
constexpr std::size_t kBlock = 512;

/// A kernel returns the floating point operations that it took.
struct Kernel {
  std::string name;
  std::function<double()> run;
  std::vector<double> seconds = {};
  double flops = 0.0;

  void time() {
    const auto start = std::chrono::steady_clock::now();
    flops = run();
    seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  double median() {
    std::sort(seconds.begin(), seconds.end());
    return seconds[seconds.size() / 2];
  }
};

/// The clusters of an encoder with all its vectors, a few iterations from their seeds.
cpca::Clusterer make_clusters(const signal::Matrix& signal, const cpca::WorkingSpace& space,
                              std::size_t cluster_count, std::uint32_t component_count) {
  const auto means = cpca::seed_means(signal.values, signal.column_count, cluster_count, 1);
  cpca::Clusterer clusterer(space.rows(), space.rows().stride, space.convert(means));
  clusterer.classify(true);
  for (std::uint32_t count = 0; count <= component_count; ++count) {
    clusterer.update(std::vector<std::uint32_t>(cluster_count, count), count + 1, 1);
    clusterer.classify(count == 0);
  }
  return clusterer;
}

std::vector<float> floats_of(const cpca::Rows& rows) {
  std::vector<float> values(rows.count * rows.stride);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = rows.at(i / rows.stride, i % rows.stride);
  }
  return values;
}

/// Means and vectors of all clusters.
std::vector<float> vectors_of(const cpca::Subspaces& subspaces) {
  std::vector<float> vectors;
  for (const auto& rows : subspaces.values) vectors.insert(vectors.end(), rows.begin(), rows.end());
  return vectors;
}

double multiply_by_blas(const std::vector<float>& rows, std::size_t n,
                        const std::vector<float>& subspaces, std::size_t stride,
                        std::vector<float>& products) {
  const std::size_t vectors = subspaces.size() / stride;
  parallel_for(rows.size() / n, kBlock, [&](std::size_t begin, std::size_t end) {
    linalg::gemm(1.0f, {&rows[begin * n], end - begin, n}, linalg::Transpose::no,
                 {subspaces.data(), vectors, n, stride}, linalg::Transpose::yes, 0.0f,
                 {&products[begin * vectors], end - begin, vectors});
  });
  return 2.0 * static_cast<double>(rows.size() * vectors);
}

double project(const signal::Matrix& signal, const cpca::PrincipalAxes& axes) {
  const std::size_t n = signal.column_count;
  parallel_for(signal.row_count, kBlock, [&](std::size_t begin, std::size_t end) {
    cpca::to_axes(axes, std::span(signal.values).subspan(begin * n, (end - begin) * n));
  });
  return 2.0 * static_cast<double>(signal.values.size() * axes.count());
}

void run(const signal::Matrix& signal, std::size_t cluster_count, std::uint32_t component_count) {
  const cpca::WorkingSpace space(signal.values, signal.column_count, {});
  const std::size_t axis_count = space.rows().stride;
  const auto axes = cpca::find_principal_axes(signal.values, signal.column_count, axis_count, {});
  cpca::Clusterer clusterer = make_clusters(signal, space, cluster_count, component_count);
  const std::vector<std::uint32_t> used(cluster_count, component_count);
  const std::vector<float> vectors = vectors_of(clusterer.subspaces());
  const std::size_t stride = clusterer.subspaces().stride;
  std::vector<float> products(signal.row_count * vectors.size() / stride);
  const std::vector<float> rows = floats_of(space.rows());
  const auto taken = [&](const auto& work) {
    const double before = clusterer.flops();
    work();
    return clusterer.flops() - before;
  };
  const double all_products = 2.0 * static_cast<double>(signal.row_count * axis_count *
                                                        cluster_count * (1 + component_count));
  std::vector<Kernel> kernels;
  kernels.push_back({fmt::format("SGEMM, {}", linalg::blas_description()), [&] {
                       return multiply_by_blas(rows, axis_count, vectors, stride, products);
                     }});
  kernels.push_back(
      {"classification, full pass", [&] { return taken([&] { clusterer.classify(true); }); }});
  kernels.push_back(
      {"classification, near clusters", [&] { return taken([&] { clusterer.classify(false); }); }});
  kernels.push_back({"subspace update", [&] {
                       return taken([&] { clusterer.update(used, component_count + 1, 1); });
                     }});
  kernels.push_back({"projection on principal axes", [&] { return project(signal, axes); }});
  std::vector<double> peaks;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    peaks.push_back(bench::peak_flops());
    for (Kernel& kernel : kernels) kernel.time();
  }
  std::sort(peaks.begin(), peaks.end());
  const double peak = peaks[peaks.size() / 2], blas = kernels[0].flops / kernels[0].median();
  fmt::print("{} points x {}, {} coordinates in use, {} clusters of {} vectors\n", signal.row_count,
             signal.column_count, axis_count, cluster_count, component_count);
  fmt::print("multiply-adds in registers {:.0f} GFLOP/s\n", 1e-9 * peak);
  for (Kernel& kernel : kernels) {
    const double rate = kernel.flops / kernel.median();
    fmt::print(
        "  {:30}{:8.3f} s {:7.1f} GFLOP/s {:5.0f}% of SGEMM {:4.0f}% of peak, {:5.1f}% of "
        "products\n",
        kernel.name, kernel.median(), 1e-9 * rate, 100.0 * rate / blas, 100.0 * rate / peak,
        100.0 * kernel.flops / all_products);
  }
}

}  // namespace

int main(int argc, char** argv) {
  fmt::print("{} threads, {}\n", thread_count(), simd_level_name(simd_level()));
  const auto number = [&](int i, int otherwise) {
    return argc > i ? std::atoi(argv[i]) : otherwise;
  };
  const signal::Matrix signal = argc > 1
                                    ? signal::read_npy(argv[1])
                                    : signal::Matrix{bench::make_signal(50000, 600), 50000, 600};
  run(signal, static_cast<std::size_t>(number(2, 256)), static_cast<std::uint32_t>(number(3, 8)));
}
