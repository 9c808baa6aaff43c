// Time and memory of the iterative encoder over the number of points:
//   bench_cpca_scaling [dimension [components [iterations]]]
// Memory is the largest resident set while encoding, signal and program included. 256 clusters; 75
// coefficients, 4 components and 5 iterations unless given.
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <string>

#include "core/parallel.h"
#include "cpca/encoder.h"
#include "made_signal.h"

namespace {

using namespace prt;

/// A line of /proc/self/status, in bytes.
double memory(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(key)) return 1024.0 * std::atof(line.c_str() + key.size() + 1);
  }
  return 0.0;
}

/// VmHWM starts again from what is resident now.
void forget_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }

void run(std::size_t point_count, int dimension, const cpca::Options& options) {
  const auto signal = bench::make_signal(point_count, static_cast<std::size_t>(dimension));
  const auto bytes = static_cast<double>(signal.size() * sizeof(float));
  forget_peak();
  const double before = memory("VmRSS");
  const auto start = std::chrono::steady_clock::now();
  const cpca::Encoded encoded = cpca::encode_iterative(signal, dimension, options);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double peak = memory("VmHWM");
  fmt::print("{:>9} {:>10.1f} {:>8.2f} {:>12.2f} {:>10.1f} {:>10.2f} {:>14.2f}\n", point_count,
             1e-6 * bytes, seconds, 1e6 * seconds / static_cast<double>(point_count), 1e-6 * peak,
             peak / bytes, (peak - before) / bytes);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const auto number = [&](int i, int otherwise) {
    return argc > i ? std::atoi(argv[i]) : otherwise;
  };
  const int dimension = number(1, 75);
  const cpca::Options options{.component_count = number(2, 4), .iterations = number(3, 5)};
  fmt::print("{} threads; {} coefficients, {} clusters, {} components, {} iterations each\n",
             thread_count(), dimension, options.cluster_count, options.component_count,
             options.iterations);
  fmt::print("{:>9} {:>10} {:>8} {:>12} {:>10} {:>10} {:>14}\n", "points", "signal MB", "seconds",
             "us a point", "peak MB", "of signal", "beside signal");
  for (const std::size_t points : {10000, 50000, 250000, 1000000}) run(points, dimension, options);
}
