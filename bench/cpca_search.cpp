// How near the search comes to the least cost, and what it takes:
//   bench_cpca_search signal.npy|signal.transfer.exr BOUND [rmse|max|bytes [METHOD [alone]]]
// BOUND is a relative error or, of bytes, a size; METHOD iterative, adaptive or static. The choice
// that the search keeps is encoded once more from seeds, under max tightened as the search does it:
// what it costs who knows the right numbers.
//
// Then, unless it is to be alone, every number of vectors that could be better is encoded at full
// strength: with as many clusters as fit the least bytes so far, and when these are within the
// error, with fewer and fewer until log error can be interpolated in log clusters. From the vectors
// of the search it goes on to fewer and to more of them until two in turn bring nothing. Under max
// encodings with up to two vectors fewer and more, with clusters for 0.7 and 0.85 of the search's
// bytes, are tightened.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "core/stopwatch.h"
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
  Comparison(const signal::Matrix& signal, cpca::Method method, const cpca::Bound& bound)
      : signal_(signal),
        method_(method),
        bound_(bound),
        size_{signal.row_count, signal.column_count},
        is_tight_(bound.max_error && bound.norm == cpca::Norm::maximum) {}

  void search() {
    const auto dimension = static_cast<int>(size_.dimension);
    const cpca::Found found = cpca::encode_within(bound_, method_, signal_.values, dimension, {});
    for (const cpca::Trial& trial : found.trials) print(trial, found.alone_flops);
    const cpca::Trial& kept = found.trials[found.kept];
    best_ = kept.choice;
    worth_ = least_ = worth(kept);
    const Stopwatch stopwatch;
    const cpca::Encoded alone = encode({kept.first_cluster_count, kept.choice.component_count});
    const double seconds = stopwatch.seconds();
    fmt::print(
        "search: {} clusters, {} components, {}; {:.2f} s; said to be {:.2f} encodings, {:.2f} of "
        "their products; encoded alone {:.2f} s: {:.2f}, {:.2f}\n",
        best_.cluster_count, best_.component_count, worth_, found.seconds, found.cost(),
        found.flops_cost(), seconds, found.seconds / seconds, found.encoded.flops / alone.flops);
    std::fflush(stdout);
  }

  void look_beside() {
    const int found = best_.component_count, most = static_cast<int>(size_.dimension);
    const double bytes = static_cast<double>(bound_.cost.bytes(size_, best_));
    try_out(found);
    for (const int step : {-1, 1}) {
      for (int i = found + step, idle = 0; i >= 0 && i <= most && idle < kPatience; i += step) {
        idle = try_out(i) ? 0 : idle + 1;
      }
    }
    for (int i = std::max(0, found - 2); is_tight_ && i <= std::min(most, found + 2); ++i) {
      for (const double share : {0.7, 0.85}) try_tightened(i, share * bytes);
    }
    fmt::print("best: {} clusters, {} components: {}; the search takes {:+.1f}%\n",
               best_.cluster_count, best_.component_count, least_, 100.0 * (worth_ / least_ - 1.0));
  }

 private:
  static void print(const cpca::Trial& trial, double alone_flops) {
    fmt::print(
        "  tried: {} clusters, {} components: error {:.5g}, {} bytes, {:.2f} s, {:.2f} "
        "encodings{}\n",
        trial.choice.cluster_count, trial.choice.component_count, trial.error, trial.bytes,
        trial.seconds, trial.flops / alone_flops, trial.is_warm ? ", warm" : "");
  }

  /// Less is better.
  double worth(const cpca::Trial& trial) const {
    return bound_.max_error ? static_cast<double>(trial.bytes) : trial.error;
  }

  cpca::Encoded encode(const cpca::Choice& choice) const {
    cpca::Options options{.cluster_count = choice.cluster_count,
                          .component_count = choice.component_count};
    options.max_component_count = 2 * choice.component_count;
    cpca::Encoded encoded =
        cpca::encode(method_, signal_.values, static_cast<int>(size_.dimension), options);
    if (!is_tight_) return encoded;
    const double energy = cpca::weighted_energy(signal_.values, size_.point_count, {});
    const double point_energy = energy / static_cast<double>(size_.point_count);
    cpca::tighten(signal_.values, *bound_.max_error * *bound_.max_error * point_energy,
                  cpca::most_clusters(size_.point_count), options, encoded);
    return encoded;
  }

  double error(const cpca::Choice& choice) const {
    const cpca::Encoded encoded = cpca::encode(
        method_, signal_.values, static_cast<int>(size_.dimension),
        {.cluster_count = choice.cluster_count, .component_count = choice.component_count});
    const double error = cpca::relative_error(encoded.encoding, signal_.values, bound_.norm);
    fmt::print("  beside: {} clusters, {} components: error {:.5f}\n", choice.cluster_count,
               choice.component_count, error);
    std::fflush(stdout);
    return error;
  }

  /// The most clusters with so many vectors that take no more than that; 0: none do.
  int most_clusters(int components, double max_bytes) const {
    const auto bytes = [&](int clusters) {
      return static_cast<double>(bound_.cost.bytes(size_, {clusters, components}));
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
    const int start = most_clusters(components, bytes);
    if (start == 0) return;
    const cpca::Encoding encoding = encode({start, components}).encoding;
    const double taken = static_cast<double>(bound_.cost.bytes(encoding));
    fmt::print("  tightened from {}: {} clusters, {} components: {} bytes\n", start,
               encoding.cluster_count, components, taken);
    std::fflush(stdout);
    take({encoding.cluster_count, components}, taken);
  }

  /// Whether so many vectors are better than those before.
  bool try_out(int components) {
    const int most = most_clusters(
        components, bound_.max_error ? least_ : static_cast<double>(*bound_.max_bytes));
    if (most == 0) return false;
    if (bound_.max_bytes) return take({most, components}, error({most, components}));
    const std::optional<int> fewest = fewest_clusters(components, most);
    if (!fewest) return false;
    const cpca::Choice choice{*fewest, components};
    return take(choice, static_cast<double>(bound_.cost.bytes(size_, choice)));
  }

  bool take(const cpca::Choice& choice, double worth) {
    if (worth >= least_) return false;
    best_ = choice;
    least_ = worth;
    return true;
  }

  const signal::Matrix& signal_;
  const cpca::Method method_;
  const cpca::Bound bound_;
  const cpca::Size size_;
  const bool is_tight_;
  cpca::Choice best_;
  double worth_ = 0.0, least_ = 0.0;  ///< bytes, or error within bytes: of the search, of all
};

cpca::Method method_named(std::string_view name) {
  return name == "static"     ? cpca::Method::fixed
         : name == "adaptive" ? cpca::Method::adaptive
                              : cpca::Method::iterative;
}

cpca::Bound bound_of(std::string_view kind, double value) {
  cpca::Bound bound;
  if (kind == "bytes") {
    bound.max_bytes = static_cast<std::size_t>(value);
  } else {
    bound.max_error = value;
  }
  if (kind == "max") bound.norm = cpca::Norm::maximum;
  return bound;
}

}  // namespace

int main(int argc, char** argv) {
  const auto argument = [&](int i) { return std::string_view(i < argc ? argv[i] : ""); };
  if (argc < 3) {
    fmt::print(stderr,
               "bench_cpca_search signal.npy|signal.transfer.exr BOUND [rmse|max|bytes "
               "[METHOD [alone]]]\n");
    return 2;
  }
  const signal::Matrix signal = read(argv[1]);
  Comparison comparison(signal, method_named(argument(4)),
                        bound_of(argument(3), std::atof(argv[2])));
  comparison.search();
  if (argument(5) != "alone") comparison.look_beside();
}
