#include "cpca/trim.h"

#include <algorithm>

#include "cpca/allocation.h"
#include "cpca/clusters.h"

namespace prt::cpca {

namespace {

/// Steps in which bytes that are too many go.
constexpr std::size_t kSteps = 4;

/// Σ D_i² of the first vectors of the clusters.
double captured(std::span<const double> variances, std::size_t most,
                std::span<const std::uint32_t> counts) {
  double sum = 0.0;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    for (std::size_t i = 0; i < counts[k]; ++i) sum += variances[k * most + i];
  }
  return sum;
}

}  // namespace

void trim(std::span<const float> point_weights, std::size_t budget, Encoding& encoding) {
  const auto most = static_cast<std::size_t>(encoding.component_count);
  const auto n = static_cast<std::size_t>(encoding.dimension);
  const auto cluster_count = static_cast<std::size_t>(encoding.cluster_count);
  std::vector<double> variances(cluster_count * most);
  for (std::size_t p = 0; p < encoding.point_count; ++p) {
    for (std::size_t i = 0; i < most; ++i) {
      const double weight = encoding.weights[p * most + i];
      variances[encoding.cluster_of_point[p] * most + i] +=
          weight * weight * (point_weights.empty() ? 1.0 : double{point_weights[p]});
    }
  }
  std::vector<std::uint32_t>& counts = encoding.component_counts;
  counts = allocate(variances, most,
                    point_counts(sort_by_cluster(encoding.cluster_of_point, cluster_count)), budget)
               .counts;
  std::vector<std::uint32_t> alike(cluster_count);
  for (std::size_t k = 0; k < cluster_count; ++k) {
    const std::size_t wanted = std::min(most, budget / encoding.point_count);
    while (alike[k] < wanted && variances[k * most + alike[k]] > 0.0) ++alike[k];
  }
  if (captured(variances, most, alike) > captured(variances, most, counts)) counts = alike;
  const std::size_t left = *std::max_element(counts.begin(), counts.end());
  for (std::size_t k = 0; k < cluster_count; ++k) {
    for (std::size_t i = 0; i < left; ++i) {
      float* to = &encoding.bases[(k * left + i) * n];
      if (i < counts[k]) {
        std::copy_n(&encoding.bases[(k * most + i) * n], n, to);
      } else {
        std::fill_n(to, n, 0.0f);
      }
    }
  }
  for (std::size_t p = 0; p < encoding.point_count; ++p) {
    const std::size_t count = counts[encoding.cluster_of_point[p]];
    for (std::size_t i = 0; i < left; ++i) {
      encoding.weights[p * left + i] = i < count ? encoding.weights[p * most + i] : 0.0f;
    }
  }
  encoding.component_count = static_cast<int>(left);
  encoding.bases.resize(cluster_count * left * n);
  encoding.weights.resize(encoding.point_count * left);
}

void trim_to_bytes(std::span<const float> point_weights, const StorageCost& cost,
                   std::size_t max_bytes, Encoding& encoding) {
  while (encoding.component_count > 0 && cost.bytes(encoding) > max_bytes) {
    const std::size_t excess = cost.bytes(encoding) - max_bytes;
    std::size_t budget = 0;
    for (const std::uint32_t cluster : encoding.cluster_of_point) {
      budget += static_cast<std::size_t>(encoding.component_count_of(static_cast<int>(cluster)));
    }
    // Vectors that go take bytes of their own with them: a little at a time.
    const std::size_t step = excess / (kSteps * cost.bytes_per_weight) + 1;
    trim(point_weights, budget - std::min(budget, step), encoding);
  }
}

}  // namespace prt::cpca
