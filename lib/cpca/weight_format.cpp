#include "cpca/weight_format.h"

#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "cpca/clusters.h"

namespace prt::cpca {

namespace {

/// One component of one cluster: its weights become shares of their range.
void normalize_component(std::span<const std::uint32_t> points, std::size_t component, float most,
                         std::span<float> basis, std::span<double> mean, Encoding& encoding) {
  const auto weight = [&](std::uint32_t point) -> float& {
    return encoding.weights[point * static_cast<std::size_t>(encoding.component_count) + component];
  };
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (const std::uint32_t point : points) {
    low = std::min(low, weight(point));
    high = std::max(high, weight(point));
  }
  const double range = double{high} - double{low};
  for (std::size_t j = 0; j < basis.size(); ++j) {
    mean[j] += double{low} * double{basis[j]};
    basis[j] = static_cast<float>(range * double{basis[j]});
  }
  for (const std::uint32_t point : points) {
    const double share = range > 0.0 ? (double{weight(point)} - double{low}) / range : 0.0;
    weight(point) = static_cast<float>(std::round(share * double{most})) / most;
  }
}

void normalize_weights(float most, Encoding& encoding) {
  const auto n = static_cast<std::size_t>(encoding.dimension);
  const auto components = static_cast<std::size_t>(encoding.component_count);
  const auto cluster_count = static_cast<std::size_t>(encoding.cluster_count);
  const PointsByCluster sorted = sort_by_cluster(encoding.cluster_of_point, cluster_count);
  parallel_for(cluster_count, 1, [&](std::size_t k, std::size_t) {
    if (sorted.of(k).empty()) return;
    const std::span<float> mean = std::span(encoding.means).subspan(k * n, n);
    std::vector<double> moved(mean.begin(), mean.end());
    const int own_count = encoding.component_count_of(static_cast<int>(k));
    for (std::size_t i = 0; i < static_cast<std::size_t>(own_count); ++i) {
      normalize_component(sorted.of(k), i, most,
                          std::span(encoding.bases).subspan((k * components + i) * n, n), moved,
                          encoding);
    }
    std::transform(moved.begin(), moved.end(), mean.begin(),
                   [](double value) { return static_cast<float>(value); });
  });
}

bool is_beyond_half(float weight) { return !half(weight).isFinite(); }

void round_to_half(Encoding& encoding) {
  for (float& weight : encoding.weights) {
    if (is_beyond_half(weight)) {
      throw_failed("a weight beyond the range of half floats",
                   {.found = fmt::format("{}", weight),
                    .expected = fmt::format("at most {}", kGreatestHalf),
                    .advice = "Store weights as float or unorm16."});
    }
    weight = half(weight);
  }
}

/// Whether convert_weights can.
bool holds(WeightFormat format, const Encoding& encoding) {
  return format != WeightFormat::float16 ||
         std::none_of(encoding.weights.begin(), encoding.weights.end(), is_beyond_half);
}

template <class Number, class Convert>
std::vector<std::byte> to_bytes(std::span<const float> weights, const Convert& convert) {
  std::vector<Number> numbers(weights.size());
  std::transform(weights.begin(), weights.end(), numbers.begin(),
                 [&](float weight) { return static_cast<Number>(convert(weight)); });
  const auto bytes = std::as_bytes(std::span(numbers));
  return {bytes.begin(), bytes.end()};
}

constexpr struct {
  const char* name;
  std::size_t bytes;
  float greatest;  // of normalised integers
} kFormats[] = {
    {"float", 4, 0.0f}, {"half", 2, 0.0f}, {"unorm16", 2, 65535.0f}, {"unorm8", 1, 255.0f}};

const auto& properties(WeightFormat format) { return kFormats[static_cast<std::size_t>(format)]; }

}  // namespace

const char* name_of(WeightFormat format) { return properties(format).name; }

std::size_t bytes_of(WeightFormat format) { return properties(format).bytes; }

bool is_normalized(WeightFormat format) { return greatest(format) > 0.0f; }

float greatest(WeightFormat format) { return properties(format).greatest; }

void convert_weights(WeightFormat format, Encoding& encoding) {
  if (is_normalized(format)) normalize_weights(greatest(format), encoding);
  if (format == WeightFormat::float16) round_to_half(encoding);
}

std::vector<std::byte> stored_weights(WeightFormat format, std::span<const float> weights) {
  const auto whole = [&](float weight) { return std::lround(weight * greatest(format)); };
  switch (format) {
    case WeightFormat::float16:
      return to_bytes<std::uint16_t>(weights, [](float weight) { return half(weight).bits(); });
    case WeightFormat::unorm16:
      return to_bytes<std::uint16_t>(weights, whole);
    case WeightFormat::unorm8:
      return to_bytes<std::uint8_t>(weights, whole);
    default:
      return to_bytes<float>(weights, std::identity());
  }
}

float weight_from_half(std::uint16_t bits) { return half(half::FromBits, bits); }

WeightFormat choose_weights(std::span<const float> signal, std::optional<WeightFormat> format,
                            Encoding& encoding, const ErrorLimits& limits) {
  if (format) {
    convert_weights(*format, encoding);
    return *format;
  }
  const auto sum = [](const std::vector<double>& errors) {
    return std::accumulate(errors.begin(), errors.end(), 0.0);
  };
  const double exact = sum(weighted_errors(encoding, signal, limits.point_weights));
  double least = std::min(limits.total, (1.0 + kMaxAddedError) * exact);
  WeightFormat chosen = WeightFormat::float32;
  // Of formats of one size the last that is as good: where it makes no difference, integers.
  for (const WeightFormat smaller :
       {WeightFormat::unorm8, WeightFormat::float16, WeightFormat::unorm16}) {
    if (bytes_of(chosen) < bytes_of(smaller)) break;
    if (!holds(smaller, encoding)) continue;
    Encoding converted = encoding;
    convert_weights(smaller, converted);
    const std::vector<double> errors = weighted_errors(converted, signal, limits.point_weights);
    const double total = sum(errors);
    if (total > least || *std::max_element(errors.begin(), errors.end()) > limits.point) continue;
    least = total;
    chosen = smaller;
  }
  convert_weights(chosen, encoding);
  return chosen;
}

}  // namespace prt::cpca
