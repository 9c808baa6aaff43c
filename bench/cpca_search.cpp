// How near the search for --max-error comes to the least cost, and what it takes:
//   bench_cpca_search signal.npy|signal.transfer.exr max_error [rmse|max]
// Beside it every number of vectors that could be better is encoded at full strength: with as many
// clusters as fit the least bytes so far, and when these are within the bound, with fewer and fewer
// until log error can be interpolated in log clusters. From the vectors of the search it goes on to
// fewer and to more of them until two in turn bring nothing. Under max these are encodings as they
// come; then with one and two vectors fewer and more, and with clusters for 0.7 and 0.85 of the
// search's bytes, encodings are tightened as the search does it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <optional>

#include "cpca/search.h"
#include "cpca/search_survey.h"
#include "cpca/tighten.h"
#include "signal/npy.h"
#include "signal/transfer_signal.h"

namespace {

using namespace prt;

/// Between so many clusters and as many times more errors are interpolated.
constexpr double kStep = 1.15;
/// Nor are so many times fewer clusters encoded.
constexpr double kClose = 0.98;
/// The usual exponent of the error over clusters.
constexpr double kSlope = 0.5;
/// Numbers of vectors in turn that bring nothing, after which there is no use in going on.
constexpr int kPatience = 2;

signal::Matrix read(const std::filesystem::path& path) {
  if (path.extension() != ".exr") return signal::read_npy(path);
  signal::TransferSignal transfer = signal::read_transfer(path);
  const std::size_t point_count = transfer.vertex_count();
  return {std::move(transfer.values), point_count, static_cast<std::size_t>(transfer.dimension())};
}

class Comparison {
 public:
  Comparison(const signal::Matrix& signal, const cpca::Bound& bound)
      : signal_(signal), bound_(bound), size_{signal.row_count, signal.column_count} {}

  /// Returns the bytes of the search over the least that were found, by any way.
  double run() {
    const auto dimension = static_cast<int>(size_.dimension);
    const cpca::Found found =
        cpca::encode_within(bound_, cpca::Method::iterative, signal_.values, dimension, {});
    print(found);
    const int components = found.encoded.encoding.component_count;
    const std::size_t bytes = bound_.cost.bytes(found.encoded.encoding);
    best_ = {found.encoded.encoding.cluster_count, components};
    least_ = bytes;
    try_out(components);
    for (const int step : {-1, 1}) {
      for (int i = components + step, idle = 0; i >= 0 && i <= dimension && idle < kPatience;
           i += step) {
        idle = try_out(i) ? 0 : idle + 1;
      }
    }
    if (bound_.norm == cpca::Norm::maximum) {
      for (int i = std::max(0, components - 2); i <= std::min(dimension, components + 2); ++i) {
        for (const double share : {0.7, 0.85}) try_tightened(i, share * static_cast<double>(bytes));
      }
    }
    return static_cast<double>(bytes) / static_cast<double>(least_);
  }

  const cpca::Choice& best() const { return best_; }
  std::size_t least() const { return least_; }

 private:
  static void print(const cpca::Found& found) {
    for (const cpca::Trial& trial : found.trials) {
      fmt::print("  tried: {} clusters, {} components: error {:.5f}, {} bytes, {:.2f} s{}\n",
                 trial.choice.cluster_count, trial.choice.component_count, trial.error, trial.bytes,
                 trial.seconds, trial.is_warm ? ", warm" : "");
    }
    fmt::print("search: {:.2f} s, {:.2f} encodings' time, {:.2f} of their products\n",
               found.seconds, found.cost, found.flops_cost);
    std::fflush(stdout);
  }

  double error(const cpca::Choice& choice) const {
    const cpca::Encoded encoded = cpca::encode_iterative(
        signal_.values, static_cast<int>(size_.dimension),
        {.cluster_count = choice.cluster_count, .component_count = choice.component_count});
    const double error = cpca::relative_error(encoded.encoding, signal_.values, bound_.norm);
    fmt::print("  beside: {} clusters, {} components: error {:.5f}\n", choice.cluster_count,
               choice.component_count, error);
    std::fflush(stdout);
    return error;
  }

  /// The most clusters with so many vectors that take no more than that; 0: none do.
  int most_clusters(int components, std::size_t max_bytes) const {
    const auto bytes = [&](int clusters) {
      return bound_.cost.bytes(size_, {clusters, components});
    };
    if (bytes(1) > max_bytes) return 0;
    const auto more = static_cast<int>((max_bytes - bytes(1)) / (bytes(2) - bytes(1)));
    return std::min(1 + more, cpca::most_clusters(size_.point_count));
  }

  /// The fewest clusters with so many vectors that keep to the bound, if `high` do.
  std::optional<int> fewest_clusters(int components, int high) const {
    const double max_error = *bound_.max_error;
    double high_error = error({high, components}), low_error = 0.0;
    if (high_error > max_error) return std::nullopt;
    int low = 0;
    while (true) {
      const double slope =
          low > 0 ? std::log(low_error / high_error) / std::log(static_cast<double>(high) / low)
                  : kSlope;
      const double share = std::pow(high_error / max_error, 1.0 / slope);
      const int guess = std::max(low + 1, static_cast<int>(std::ceil(share * high)));
      if (guess > kClose * high || (low > 0 && high <= kStep * low)) return std::min(guess, high);
      const double guess_error = error({guess, components});
      (guess_error <= max_error ? high : low) = guess;
      (guess_error <= max_error ? high_error : low_error) = guess_error;
    }
  }

  void try_tightened(int components, double bytes) {
    const int start = most_clusters(components, static_cast<std::size_t>(bytes));
    if (start == 0) return;
    const cpca::Options options{.cluster_count = start, .component_count = components};
    cpca::Encoded encoded =
        cpca::encode_iterative(signal_.values, static_cast<int>(size_.dimension), options);
    const double energy = cpca::weighted_energy(signal_.values, size_.point_count, {});
    cpca::tighten(
        signal_.values,
        *bound_.max_error * *bound_.max_error * energy / static_cast<double>(size_.point_count),
        cpca::most_clusters(size_.point_count), options, encoded);
    const cpca::Choice found{encoded.encoding.cluster_count, components};
    const std::size_t taken = bound_.cost.bytes(size_, found);
    fmt::print("  tightened from {}: {} clusters, {} components: {} bytes\n", start,
               found.cluster_count, components, taken);
    std::fflush(stdout);
    if (taken >= least_) return;
    best_ = found;
    least_ = taken;
  }

  /// Whether so many vectors take less bytes than those before.
  bool try_out(int components) {
    const int most = most_clusters(components, least_);
    if (most == 0) return false;
    const std::optional<int> fewest = fewest_clusters(components, most);
    if (!fewest) return false;
    const std::size_t bytes = bound_.cost.bytes(size_, {*fewest, components});
    if (bytes >= least_) return false;
    best_ = {*fewest, components};
    least_ = bytes;
    return true;
  }

  const signal::Matrix& signal_;
  const cpca::Bound bound_;
  const cpca::Size size_;
  cpca::Choice best_;
  std::size_t least_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "bench_cpca_search signal.npy|signal.transfer.exr max_error [rmse|max]\n");
    return 2;
  }
  const bool is_max = argc > 3 && std::strcmp(argv[3], "max") == 0;
  const signal::Matrix signal = read(argv[1]);
  Comparison comparison(signal, {.max_error = std::atof(argv[2]),
                                 .norm = is_max ? cpca::Norm::maximum : cpca::Norm::rmse,
                                 .max_bytes = {}});
  const double share = comparison.run();
  fmt::print("best: {} clusters, {} components: {} bytes; the search takes {:+.1f}%\n",
             comparison.best().cluster_count, comparison.best().component_count, comparison.least(),
             100.0 * (share - 1.0));
}
