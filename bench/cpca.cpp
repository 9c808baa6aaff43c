// Speed of static clustered PCA, beside the matrix products of the installed BLAS and beside the
// peak of the arithmetic units in the same run:
//   bench_cpca [points dimension clusters]…
// Without arguments: the reference problem of glossy transfer, then diffuse transfer of a bunny.
// Times are medians of several, interleaved, since other load comes and goes.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/cpu.h"
#include "core/parallel.h"
#include "cpca/encoder.h"
#include "cpca/figures.h"
#include "cpca/nearest_mean.h"
#include "cpca/quantizer.h"
#include "cpca/seeding.h"
#include "linalg/product.h"
#include "made_signal.h"
#include "peak.h"

namespace {

using namespace prt;

constexpr std::size_t kBlock = 448;

struct Problem {
  std::size_t point_count, dimension, cluster_count;
};

template <class Work>
double seconds_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void multiply_by_blas(const Problem& problem, const std::vector<float>& signal,
                      const std::vector<float>& means, std::vector<float>& scores) {
  const auto& [point_count, n, cluster_count] = problem;
  parallel_for(point_count, kBlock,
               [&, n = n, k = cluster_count](std::size_t begin, std::size_t end) {
                 linalg::gemm(1.0f, {&signal[begin * n], end - begin, n}, linalg::Transpose::no,
                              {means.data(), k, n}, linalg::Transpose::yes, 0.0f,
                              {&scores[begin * k], end - begin, k});
               });
}

void classify(const Problem& problem, const std::vector<float>& signal,
              const std::vector<float>& means, std::vector<std::uint32_t>& labels) {
  const cpca::NearestMean nearest(means, {means.data(), problem.dimension});
  parallel_for(problem.point_count, kBlock, [&](std::size_t begin, std::size_t end) {
    nearest.classify(signal, begin, end, labels);
  });
}

void run(const Problem& problem) {
  constexpr int kIterations = 20, kRepetitions = 5;
  const auto& [point_count, n, cluster_count] = problem;
  const std::vector<float> signal = bench::make_signal(point_count, n);
  std::vector<float> means, scores(point_count * cluster_count);
  std::vector<std::uint32_t> labels(point_count);
  std::vector<double> blas, peak, classification, clustering, seeding;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    seeding.push_back(seconds_of([&] { means = cpca::seed_means(signal, n, cluster_count, 1); }));
    blas.push_back(seconds_of([&] { multiply_by_blas(problem, signal, means, scores); }));
    peak.push_back(1e-9 * bench::peak_flops());
    classification.push_back(seconds_of([&] { classify(problem, signal, means, labels); }));
    int iterations = 0;
    const double elapsed =
        seconds_of([&] { iterations = cpca::quantize(signal, n, means, kIterations).iterations; });
    clustering.push_back(elapsed / iterations * kIterations);
    peak.push_back(1e-9 * bench::peak_flops());
  }
  const double gflop =
      2e-9 * static_cast<double>(point_count) * static_cast<double>(n * cluster_count);
  const double peak_rate = median(peak), blas_rate = gflop / median(blas);
  const auto print_rate = [&](const std::string& name, double seconds, double products) {
    const double rate = products * gflop / seconds;
    fmt::print("  {:28}{:8.3f} s {:8.1f} GFLOP/s {:5.0f}% of SGEMM {:4.0f}% of peak\n", name,
               seconds, rate, 100.0 * rate / blas_rate, 100.0 * rate / peak_rate);
  };
  fmt::print("{} points x {}, {} clusters; multiply-adds in registers {:.1f} GFLOP/s\n",
             point_count, n, cluster_count, peak_rate);
  print_rate(fmt::format("SGEMM, {}", linalg::blas_description()), median(blas), 1.0);
  print_rate("classification alone", median(classification), 1.0);
  print_rate(fmt::format("{} LBG iterations", kIterations), median(clustering), kIterations);
  print_rate("the same with seeding", median(clustering) + median(seeding), kIterations);

  cpca::Encoded encoded;
  const double encoding = seconds_of([&] {
    encoded = cpca::encode_static(signal, static_cast<int>(n),
                                  {.cluster_count = static_cast<int>(cluster_count)});
  });
  fmt::print("  static, 8 components         {:8.3f} s:", encoding);
  for (const cpca::Stage& stage : encoded.stages) {
    fmt::print(" {} {:.3f}", stage.name, stage.seconds);
  }
  std::vector<double> errors;
  const double measuring =
      seconds_of([&] { errors = cpca::point_errors(encoded.encoding, signal); });
  fmt::print("\n  errors of all points         {:8.3f} s, relative RMSE {:.4f}\n", measuring,
             cpca::summarize(errors, signal).relative_rmse());
}

}  // namespace

int main(int argc, char** argv) {
  fmt::print("{} threads, {}\n", thread_count(), simd_level_name(simd_level()));
  std::vector<Problem> problems;
  for (int i = 1; i + 2 < argc; i += 3) {
    problems.push_back({std::strtoul(argv[i], nullptr, 10), std::strtoul(argv[i + 1], nullptr, 10),
                        std::strtoul(argv[i + 2], nullptr, 10)});
  }
  if (problems.empty()) problems = {{50000, 600, 256}, {34835, 75, 256}, {34835, 25, 256}};
  for (const Problem& problem : problems) run(problem);
}
