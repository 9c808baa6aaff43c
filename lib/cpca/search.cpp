#include "cpca/search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"
#include "core/log.h"
#include "cpca/figures.h"
#include "cpca/stage_clock.h"

namespace prt::cpca {

namespace {

constexpr int kSurveyIterations = 4, kMaxComponents = 24, kMaxEncodings = 3;
constexpr std::size_t kLeastClusters = 8, kMostClusters = 4096, kPointsPerCluster = 12,
                      kIndexedClusters = 65536;
/// Squared error of the iterative encoder over that of a static one, to begin with.
constexpr double kFirstGain = 0.5;

struct Choice {
  int cluster_count = 0, component_count = 0;
  double error = 0.0;  ///< relative, of the survey
  std::size_t bytes = 0;

  bool operator==(const Choice&) const = default;
};

std::size_t padded(std::size_t weight_count, const StorageCost& cost) {
  return (weight_count + cost.weight_group - 1) / cost.weight_group * cost.weight_group;
}

std::size_t bytes_of(std::size_t point_count, int dimension, int cluster_count, int component_count,
                     const StorageCost& cost) {
  const auto clusters = static_cast<std::size_t>(cluster_count);
  const auto components = static_cast<std::size_t>(component_count);
  return cost.total(point_count, point_count * padded(components, cost), clusters,
                    clusters * components, static_cast<std::size_t>(dimension));
}

std::size_t bytes_of(const Encoding& encoding, const StorageCost& cost) {
  std::size_t weights = 0, vectors = 0;
  const auto count_of = [&](int cluster) {
    return static_cast<std::size_t>(encoding.component_count_of(cluster));
  };
  for (int k = 0; k < encoding.cluster_count; ++k) vectors += count_of(k);
  for (std::uint32_t cluster : encoding.cluster_of_point) {
    weights += padded(count_of(static_cast<int>(cluster)), cost);
  }
  return cost.total(encoding.point_count, weights, static_cast<std::size_t>(encoding.cluster_count),
                    vectors, static_cast<std::size_t>(encoding.dimension));
}

/// As many more clusters as fit into the bytes.
void fill(Choice& choice, std::size_t max_bytes, std::size_t point_count, int dimension,
          const StorageCost& cost) {
  const auto bytes = [&](int clusters) {
    return bytes_of(point_count, dimension, clusters, choice.component_count, cost);
  };
  const std::size_t one = bytes(2) - bytes(1), used = bytes(choice.cluster_count);
  const std::size_t most = std::min<std::size_t>(
      {point_count, kIndexedClusters,
       static_cast<std::size_t>(choice.cluster_count) + (max_bytes - used) / one});
  choice.cluster_count = static_cast<int>(most);
  choice.bytes = bytes(choice.cluster_count);
}

double relative(double squared_error, double largest, const Figures& figures,
                std::size_t point_count, Norm norm) {
  if (figures.signal_energy <= 0.0) return 0.0;
  return norm == Norm::rmse
             ? std::sqrt(squared_error / figures.signal_energy)
             : std::sqrt(largest * static_cast<double>(point_count) / figures.signal_energy);
}

/// Errors of a static encoding with its first 0, 1, … vectors.
void add_choices(const Encoding& encoding, std::span<const float> signal, const Bound& bound,
                 std::vector<Choice>& choices) {
  const std::vector<double> last = point_errors(encoding, signal);
  const Figures figures = summarize(last, signal);
  const auto count = static_cast<std::size_t>(encoding.component_count);
  std::vector<double> errors = last;
  for (int components = encoding.component_count; components >= 0; --components) {
    double sum = 0.0, largest = 0.0;
    for (std::size_t p = 0; p < errors.size(); ++p) {
      sum += errors[p];
      largest = std::max(largest, errors[p]);
      if (components == 0) continue;
      const double weight = encoding.weights[p * count + static_cast<std::size_t>(components) - 1];
      errors[p] += weight * weight;
    }
    choices.push_back({encoding.cluster_count, components,
                       relative(sum, largest, figures, errors.size(), bound.norm),
                       bytes_of(encoding.point_count, encoding.dimension, encoding.cluster_count,
                                components, bound.cost)});
  }
}

std::vector<Choice> survey(std::span<const float> signal, int dimension, const Bound& bound,
                           Options options) {
  const std::size_t point_count = signal.size() / static_cast<std::size_t>(dimension);
  const std::size_t most =
      std::clamp<std::size_t>(point_count / kPointsPerCluster, 1, kMostClusters);
  options.iterations = kSurveyIterations;
  options.component_count = std::min(dimension, kMaxComponents);
  std::vector<Choice> choices;
  for (std::size_t clusters = std::min(kLeastClusters, most);; clusters *= 2) {
    options.cluster_count = static_cast<int>(std::min(clusters, most));
    add_choices(encode_static(signal, dimension, options).encoding, signal, bound, choices);
    if (clusters >= most) return choices;
  }
}

/// The best choice if the encoder's errors are `gain` times those of the survey; the one of least
/// error if none keeps to an error bound.
Choice choose(std::span<const Choice> choices, const Bound& bound, double gain) {
  const auto by_error = [](const Choice& a, const Choice& b) {
    return a.error != b.error ? a.error < b.error : a.bytes < b.bytes;
  };
  std::vector<Choice> within;
  for (const Choice& choice : choices) {
    if (bound.max_error ? choice.error * gain <= *bound.max_error
                        : choice.bytes <= *bound.max_bytes) {
      within.push_back(choice);
    }
  }
  if (bound.max_error && within.empty()) {
    return *std::min_element(choices.begin(), choices.end(), by_error);
  }
  if (within.empty()) {
    const auto least = std::min_element(choices.begin(), choices.end(),
                                        [](auto& a, auto& b) { return a.bytes < b.bytes; });
    throw Error(ErrorKind::failed, "no encoding is as small",
                {.found = fmt::format("at least {} bytes", least->bytes),
                 .expected = fmt::format("at most {}", *bound.max_bytes)});
  }
  return bound.max_error ? *std::min_element(within.begin(), within.end(),
                                             [](const Choice& a, const Choice& b) {
                                               return a.bytes != b.bytes ? a.bytes < b.bytes
                                                                         : a.error < b.error;
                                             })
                         : *std::min_element(within.begin(), within.end(), by_error);
}

}  // namespace

double relative_error(const Encoding& encoding, std::span<const float> signal, Norm norm) {
  const Figures figures = summarize(point_errors(encoding, signal), signal);
  return relative(figures.squared_error, figures.max_point_error, figures, encoding.point_count,
                  norm);
}

Encoded encode_within(const Bound& bound, const Encoder& encoder, std::span<const float> signal,
                      int dimension, const Options& options) {
  Options tried = options;
  tried.cluster_count = 1;
  tried.component_count = 0;
  check_options(tried);
  check_signal(signal, dimension, tried);
  std::vector<Stage> stages;
  StageClock clock(stages);
  const std::vector<Choice> choices = survey(signal, dimension, bound, options);
  clock.finish("survey");
  std::optional<Encoded> best;
  double gain = std::sqrt(kFirstGain), least = std::numeric_limits<double>::infinity();
  std::vector<Choice> done;
  Bound aim = bound;  // lower than max_bytes after an adaptive encoding of more vectors than chosen
  while (done.size() < kMaxEncodings) {
    Choice choice = choose(choices, aim, gain);
    if (aim.max_bytes) {
      fill(choice, *aim.max_bytes, signal.size() / static_cast<std::size_t>(dimension), dimension,
           bound.cost);
    }
    if (std::find(done.begin(), done.end(), choice) != done.end()) break;
    done.push_back(choice);
    tried.cluster_count = choice.cluster_count;
    tried.component_count = choice.component_count;
    Encoded encoded = encoder(signal, dimension, tried);
    for (const Stage& stage : encoded.stages) stages.push_back(stage);
    const double error = relative_error(encoded.encoding, signal, bound.norm);
    const std::size_t bytes = bytes_of(encoded.encoding, bound.cost);
    log::info("{} clusters, {} components: relative error {:.3g}, {} bytes", choice.cluster_count,
              choice.component_count, error, bytes);
    if (bound.max_bytes) {
      if (bytes > *bound.max_bytes) {
        // Once more, smaller by as much as this is too large.
        *aim.max_bytes = static_cast<std::size_t>(0.98 * static_cast<double>(*aim.max_bytes) *
                                                  static_cast<double>(*bound.max_bytes) /
                                                  static_cast<double>(bytes));
        continue;
      }
      best = std::move(encoded);
      break;
    }
    least = std::min(least, error);
    // A little more, as the next choice is not quite like this one.
    if (choice.error > 0.0) gain = 1.02 * error / choice.error;
    if (bound.max_error && error > *bound.max_error) continue;
    if (best && bytes_of(best->encoding, bound.cost) <= bytes) continue;
    best = std::move(encoded);
  }
  if (!best && bound.max_bytes) {
    throw Error(ErrorKind::failed, "no encoding found that is as small",
                {.expected = fmt::format("at most {} bytes", *bound.max_bytes),
                 .advice = "Take --method iterative."});
  }
  if (!best) {
    throw Error(ErrorKind::failed, "no encoding found within the error",
                {.found = fmt::format("a relative error of {:.4g}", least),
                 .expected = fmt::format("at most {:.4g}", *bound.max_error)});
  }
  best->stages = std::move(stages);
  return std::move(*best);
}

}  // namespace prt::cpca
