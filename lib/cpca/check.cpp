#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "cpca/encoder.h"

namespace prt::cpca {

namespace {

void reject(const char* what, long found, const std::string& expected, const char* advice = "") {
  throw Error(ErrorKind::usage, what,
              {.found = std::to_string(found), .expected = expected, .advice = advice});
}

constexpr std::size_t kFinite = std::numeric_limits<std::size_t>::max();

/// Squares of greater values, summed up, would leave the range of float.
constexpr float kGreatest = 1e15f;

/// Index of the first value that is not finite or too great.
std::size_t first_bad_value(std::span<const float> signal) {
  std::atomic<std::size_t> first{kFinite};
  parallel_for(signal.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
    const auto bad = std::find_if_not(&signal[begin], &signal[begin] + (end - begin),
                                      [](float value) { return std::abs(value) <= kGreatest; });
    const auto index = static_cast<std::size_t>(bad - signal.data());
    if (index == end) return;
    std::size_t known = first.load();
    while (index < known && !first.compare_exchange_weak(known, index)) {
    }
  });
  return first.load();
}

}  // namespace

void check_options(const Options& options) {
  if (options.cluster_count < 1) {
    reject("number of clusters", options.cluster_count, "at least 1");
  }
  if (options.component_count < 0) {
    reject("number of components", options.component_count, "at least 0");
  }
  if (options.iterations < 1) reject("number of iterations", options.iterations, "at least 1");
}

void check_signal(std::span<const float> signal, int dimension, const Options& options) {
  if (dimension < 1 || signal.empty() || signal.size() % static_cast<std::size_t>(dimension) != 0) {
    throw_bad_input("the signal is no matrix of points",
                    {.found = fmt::format("{} values of dimension {}", signal.size(), dimension),
                     .expected = "at least one point"});
  }
  const std::size_t point_count = signal.size() / static_cast<std::size_t>(dimension);
  if (static_cast<std::size_t>(options.cluster_count) > point_count) {
    reject("more clusters than points", options.cluster_count,
           fmt::format("at most {}, one a point", point_count), "Ask for fewer with --clusters.");
  }
  if (options.component_count > dimension) {
    reject("more components than coefficients", options.component_count,
           fmt::format("at most {}", dimension), "Ask for fewer with --components.");
  }
  const std::size_t bad = first_bad_value(signal);
  if (bad != kFinite) {
    const auto n = static_cast<std::size_t>(dimension);
    const bool finite = std::isfinite(signal[bad]);
    throw_bad_input(finite ? "the signal is too great" : "the signal is not finite",
                    {.element = fmt::format("point {}, coefficient {}", bad / n, bad % n),
                     .found = fmt::format("{}", signal[bad]),
                     .expected = finite ? fmt::format("at most {}", kGreatest) : "a number"});
  }
}

}  // namespace prt::cpca
