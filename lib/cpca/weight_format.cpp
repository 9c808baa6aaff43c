#include "cpca/weight_format.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

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

bool is_within(const ErrorLimits& limits, std::span<const double> errors) {
  return std::accumulate(errors.begin(), errors.end(), 0.0) <= limits.total &&
         *std::max_element(errors.begin(), errors.end()) <= limits.point;
}

}  // namespace

const char* name_of(WeightFormat format) {
  return format == WeightFormat::float32   ? "float"
         : format == WeightFormat::unorm16 ? "unorm16"
                                           : "unorm8";
}

std::size_t bytes_of(WeightFormat format) {
  return format == WeightFormat::float32 ? 4 : format == WeightFormat::unorm16 ? 2 : 1;
}

float greatest(WeightFormat format) { return format == WeightFormat::unorm16 ? 65535.0f : 255.0f; }

void normalize_weights(WeightFormat format, Encoding& encoding) {
  if (format == WeightFormat::float32) return;
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
      normalize_component(sorted.of(k), i, greatest(format),
                          std::span(encoding.bases).subspan((k * components + i) * n, n), moved,
                          encoding);
    }
    std::transform(moved.begin(), moved.end(), mean.begin(),
                   [](double value) { return static_cast<float>(value); });
  });
}

WeightFormat choose_weights(std::span<const float> signal, std::optional<WeightFormat> format,
                            Encoding& encoding, const ErrorLimits& limits) {
  if (format) {
    normalize_weights(*format, encoding);
    return *format;
  }
  const std::vector<double> errors = weighted_errors(encoding, signal, limits.point_weights);
  ErrorLimits stricter = limits;
  stricter.total = std::min(
      limits.total, (1.0 + kMaxAddedError) * std::accumulate(errors.begin(), errors.end(), 0.0));
  for (const WeightFormat smaller : {WeightFormat::unorm8, WeightFormat::unorm16}) {
    Encoding normalized = encoding;
    normalize_weights(smaller, normalized);
    if (!is_within(stricter, weighted_errors(normalized, signal, limits.point_weights))) continue;
    encoding = std::move(normalized);
    return smaller;
  }
  return WeightFormat::float32;
}

}  // namespace prt::cpca
