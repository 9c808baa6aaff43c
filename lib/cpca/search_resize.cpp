#include "cpca/search_resize.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>

#include "cpca/distance.h"

namespace prt::cpca {

namespace {

/// Clusters in order of their error, the greatest first.
std::vector<std::uint32_t> by_error(const Encoding& encoding, std::span<const double> errors) {
  std::vector<double> sums(static_cast<std::size_t>(encoding.cluster_count));
  for (std::size_t p = 0; p < errors.size(); ++p) sums[encoding.cluster_of_point[p]] += errors[p];
  std::vector<std::uint32_t> order(sums.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return sums[a] != sums[b] ? sums[a] > sums[b] : a < b;
  });
  return order;
}

/// Of each cluster, the new one that takes one half of its points, or itself.
void split(const Encoding& encoding, std::span<const double> errors,
           std::span<const std::uint32_t> other_half, std::vector<std::uint32_t>& labels) {
  const auto components = static_cast<std::size_t>(encoding.component_count);
  std::vector<double> limits(other_half.size());  // where clusters have no vectors: mean errors
  std::vector<std::size_t> counts(other_half.size());
  for (std::size_t p = 0; p < labels.size(); ++p) {
    limits[labels[p]] += errors[p];
    ++counts[labels[p]];
  }
  for (std::size_t p = 0; p < labels.size(); ++p) {
    const std::uint32_t k = encoding.cluster_of_point[p];
    const bool is_beyond = encoding.component_count_of(static_cast<int>(k)) > 0
                               ? encoding.weights[p * components] > 0.0f
                               : errors[p] * static_cast<double>(counts[k]) > limits[k];
    if (is_beyond) labels[p] = other_half[k];
  }
}

/// The nearest mean among clusters that stay.
std::uint32_t nearest(const Encoding& encoding, std::uint32_t cluster,
                      std::span<const std::uint32_t> staying) {
  std::uint32_t best = staying.front();
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t other : staying) {
    const double distance = squared_distance(encoding.mean(static_cast<int>(cluster)),
                                             encoding.mean(static_cast<int>(other)));
    if (distance >= least) continue;
    least = distance;
    best = other;
  }
  return best;
}

}  // namespace

std::vector<std::uint32_t> resize_clusters(const Encoding& encoding, std::span<const double> errors,
                                           int cluster_count) {
  assert(cluster_count >= 1 && cluster_count <= 2 * encoding.cluster_count);
  const auto before = static_cast<std::size_t>(encoding.cluster_count),
             after = static_cast<std::size_t>(cluster_count);
  const std::vector<std::uint32_t> order = by_error(encoding, errors);
  std::vector<std::uint32_t> labels = encoding.cluster_of_point, renamed(before);
  std::iota(renamed.begin(), renamed.end(), 0u);
  if (after >= before) {
    for (std::size_t k = before; k < after; ++k) {
      renamed[order[k - before]] = static_cast<std::uint32_t>(k);
    }
    split(encoding, errors, renamed, labels);
    return labels;
  }
  const std::span<const std::uint32_t> staying = std::span(order).first(after);
  for (std::size_t k = 0; k < after; ++k) renamed[order[k]] = static_cast<std::uint32_t>(k);
  for (std::size_t k = after; k < before; ++k) {
    renamed[order[k]] = renamed[nearest(encoding, order[k], staying)];
  }
  for (std::uint32_t& label : labels) label = renamed[label];
  return labels;
}

}  // namespace prt::cpca
