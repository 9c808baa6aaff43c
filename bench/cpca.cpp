// Speed of static clustered PCA, beside the matrix products of the installed BLAS in the same run:
//   bench_cpca [points dimension clusters]…
// Without arguments: the reference problem of glossy transfer, then diffuse transfer of a bunny.
// Rates of products are the best of several, interleaved, since other load comes and goes.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "core/cpu.h"
#include "core/parallel.h"
#include "core/random.h"
#include "cpca/encoder.h"
#include "cpca/figures.h"
#include "cpca/nearest_mean.h"
#include "cpca/quantizer.h"
#include "cpca/seeding.h"
#include "linalg/product.h"

namespace {

using namespace prt;

struct Problem {
  std::size_t point_count, dimension, cluster_count;
};

template <class Work>
double seconds_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Like transfer: a few families of points, each with variances that fall off, and noise.
std::vector<float> make_signal(const Problem& problem) {
  constexpr std::size_t kFamilies = 4, kDirections = 12;
  Pcg32 random(3);
  std::vector<float> directions(kFamilies * kDirections * problem.dimension);
  for (float& value : directions) value = random.uniform() - 0.5f;
  std::vector<float> signal(problem.point_count * problem.dimension);
  for (std::size_t p = 0; p < problem.point_count; ++p) {
    float* row = &signal[p * problem.dimension];
    const std::size_t family = random.below(kFamilies);
    for (std::size_t i = 0; i < problem.dimension; ++i) row[i] = 0.02f * random.uniform();
    for (std::size_t d = 0; d < kDirections; ++d) {
      const float weight = (random.uniform() - 0.5f) * std::pow(0.7f, static_cast<float>(d));
      const float* direction = &directions[(family * kDirections + d) * problem.dimension];
      for (std::size_t i = 0; i < problem.dimension; ++i) row[i] += weight * direction[i];
    }
  }
  return signal;
}

void run(const Problem& problem) {
  constexpr int kIterations = 20, kRepetitions = 6;
  constexpr std::size_t kBlock = 448;
  const auto& [point_count, n, cluster_count] = problem;
  const std::vector<float> signal = make_signal(problem);
  const double product_flops =
      2.0 * static_cast<double>(point_count) * static_cast<double>(n * cluster_count);

  std::vector<float> means;
  const double seeding = seconds_of([&] { means = cpca::seed_means(signal, n, cluster_count, 1); });
  std::vector<float> scores(point_count * cluster_count);
  std::vector<std::uint32_t> labels(point_count);
  double blas = INFINITY, classification = INFINITY, clustering = INFINITY;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    blas =
        std::min(blas, seconds_of([&] {
                   parallel_for(point_count, kBlock, [&](std::size_t begin, std::size_t end) {
                     linalg::gemm(1.0f, {&signal[begin * n], end - begin, n}, linalg::Transpose::no,
                                  {means.data(), cluster_count, n}, linalg::Transpose::yes, 0.0f,
                                  {&scores[begin * cluster_count], end - begin, cluster_count});
                   });
                 }));
    classification =
        std::min(classification, seconds_of([&] {
                   const cpca::NearestMean nearest(means, {means.data(), n});
                   parallel_for(point_count, kBlock, [&](std::size_t begin, std::size_t end) {
                     nearest.classify(signal, begin, end, labels);
                   });
                 }));
    if (repetition % 2 == 0) continue;
    int iterations = 0;
    const double elapsed =
        seconds_of([&] { iterations = cpca::quantize(signal, n, means, kIterations).iterations; });
    clustering = std::min(clustering, elapsed / iterations * kIterations);
  }
  const double blas_rate = 1e-9 * product_flops / blas;
  const double rate = 1e-9 * product_flops * kIterations / clustering;
  fmt::print("{} points x {}, {} clusters\n", point_count, n, cluster_count);
  fmt::print("  SGEMM, {:22}{:8.1f} GFLOP/s\n", linalg::blas_description(), blas_rate);
  fmt::print("  classification alone         {:8.1f} GFLOP/s\n",
             1e-9 * product_flops / classification);
  fmt::print("  {} LBG iterations            {:8.3f} s, {:.1f} GFLOP/s: {:.0f}% of SGEMM\n",
             kIterations, clustering, rate, 100.0 * rate / blas_rate);
  fmt::print("  seeding                      {:8.3f} s\n", seeding);

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
