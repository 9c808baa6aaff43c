// How near the search for --max-error comes to the least cost, and what it takes:
//   bench_cpca_search signal.npy|signal.transfer.exr max_error [clusters clusters [components]]
// Beside it every number of clusters of a grid (each 1.25 times the one before) is encoded at full
// strength with 0, 1, … vectors. The two numbers between which the bound lies are then encoded with
// just as many vectors, and between them log error is interpolated in log clusters.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "cpca/search.h"
#include "signal/npy.h"
#include "signal/transfer_signal.h"

namespace {

using namespace prt;

constexpr double kStep = 1.25;

struct Least {
  cpca::Choice choice;
  std::size_t bytes = ~std::size_t{0};
};

signal::Matrix read(const std::filesystem::path& path) {
  if (path.extension() != ".exr") return signal::read_npy(path);
  signal::TransferSignal transfer = signal::read_transfer(path);
  const std::size_t point_count = transfer.vertex_count();
  return {std::move(transfer.values), point_count, static_cast<std::size_t>(transfer.dimension())};
}

cpca::Encoded encode(const signal::Matrix& signal, const cpca::Choice& choice) {
  return cpca::encode_iterative(
      signal.values, static_cast<int>(signal.column_count),
      {.cluster_count = choice.cluster_count, .component_count = choice.component_count});
}

/// Relative errors with 0, 1, … vectors.
std::vector<double> encode_column(const signal::Matrix& signal, const cpca::Choice& most) {
  const cpca::Encoded encoded = encode(signal, most);
  const double energy = cpca::weighted_energy(signal.values, signal.row_count, {});
  std::vector<double> errors;
  for (const cpca::Level& level : encoded.levels) {
    errors.push_back(std::sqrt(level.errors.back() / energy));
  }
  return errors;
}

/// The least clusters with so many vectors that keep to the bound, by two about it.
cpca::Choice interpolate(const signal::Matrix& signal, int low, int high, int components,
                         double max_error) {
  const auto error = [&](int clusters) {
    return cpca::relative_error(encode(signal, {clusters, components}).encoding, signal.values,
                                cpca::Norm::rmse);
  };
  const double low_error = error(low), high_error = error(high);
  const double share = std::log(low_error / max_error) / std::log(low_error / high_error);
  return {static_cast<int>(std::ceil(low * std::pow(static_cast<double>(high) / low, share))),
          components};
}

Least search_grid(const signal::Matrix& signal, const cpca::Bound& bound, int first, int last,
                  int most_components) {
  const cpca::Size size{signal.row_count, signal.column_count};
  Least least;
  std::vector<double> before;
  int clusters_before = 0;
  for (double count = first; count <= last; count *= kStep) {
    const int clusters = static_cast<int>(std::lround(count));
    const std::vector<double> errors = encode_column(signal, {clusters, most_components});
    for (int i = 0; i <= most_components && !before.empty(); ++i) {
      const auto level = static_cast<std::size_t>(i);
      if (errors[level] > *bound.max_error || before[level] <= *bound.max_error) continue;
      const cpca::Choice choice =
          interpolate(signal, clusters_before, clusters, i, *bound.max_error);
      const std::size_t bytes = bound.cost.bytes(size, choice);
      fmt::print("  grid: {} clusters, {} components: {} bytes\n", choice.cluster_count, i, bytes);
      std::fflush(stdout);
      if (bytes < least.bytes) least = {choice, bytes};
    }
    before = errors;
    clusters_before = clusters;
  }
  return least;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "bench_cpca_search signal.npy max_error [clusters clusters [components]]\n");
    return 2;
  }
  const auto number = [&](int i, int otherwise) {
    return argc > i ? std::atoi(argv[i]) : otherwise;
  };
  const signal::Matrix signal = read(argv[1]);
  const cpca::Bound bound{.max_error = std::atof(argv[2]), .max_bytes = {}};
  const cpca::Found found = cpca::encode_within(bound, cpca::Method::iterative, signal.values,
                                                static_cast<int>(signal.column_count), {});
  for (const cpca::Trial& trial : found.trials) {
    fmt::print("  tried: {} clusters, {} components: error {:.5f}, {} bytes, {:.2f} s{}\n",
               trial.choice.cluster_count, trial.choice.component_count, trial.error, trial.bytes,
               trial.seconds, trial.is_warm ? ", warm" : "");
  }
  const std::size_t bytes = bound.cost.bytes(found.encoded.encoding);
  fmt::print(
      "search: {} clusters, {} components: {} bytes, {:.2f} s, {:.2f} encodings' time, "
      "{:.2f} of their products\n",
      found.encoded.encoding.cluster_count, found.encoded.encoding.component_count, bytes,
      found.seconds, found.cost, found.flops_cost);
  std::fflush(stdout);
  if (argc < 5) return 0;
  const Least least = search_grid(signal, bound, number(3, 16), number(4, 1024), number(5, 12));
  fmt::print("grid: {} clusters, {} components: {} bytes; the search takes {:+.1f}%\n",
             least.choice.cluster_count, least.choice.component_count, least.bytes,
             100.0 * (static_cast<double>(bytes) / static_cast<double>(least.bytes) - 1.0));
  return 0;
}
