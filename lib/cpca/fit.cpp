#include "cpca/fit.h"

#include "core/parallel.h"
#include "cpca/cluster_pca.h"
#include "cpca/clusters.h"
#include "cpca/subspace_kernels.h"

namespace prt::cpca {

std::vector<float> fit_means(std::span<const float> signal, std::size_t dimension,
                             std::span<const std::uint32_t> labels, std::size_t cluster_count,
                             std::span<const float> point_weights) {
  const Rows rows{signal.data(), labels.size(), dimension, point_weights};
  const PointsByCluster sorted = sort_by_cluster(labels, cluster_count);
  std::vector<float> means(cluster_count * dimension);
  parallel_for(cluster_count, 1, [&](std::size_t k, std::size_t) {
    const auto points = sorted.of(k);
    double total = 0.0;
    for (const std::uint32_t point : points) total += double{rows.weight(point)};
    if (total <= 0.0) return;
    std::vector<double> sums(dimension);
    add_rows(rows, points, sums);
    for (std::size_t i = 0; i < dimension; ++i) {
      means[k * dimension + i] = static_cast<float>(sums[i] / total);
    }
  });
  return means;
}

void fit_components(std::span<const float> signal, std::span<const float> point_weights,
                    Encoding& encoding) {
  const auto n = static_cast<std::size_t>(encoding.dimension);
  const auto cluster_count = static_cast<std::size_t>(encoding.cluster_count);
  const std::size_t basis_size = static_cast<std::size_t>(encoding.component_count) * n;
  encoding.bases.resize(cluster_count * basis_size);
  encoding.weights.resize(encoding.point_count *
                          static_cast<std::size_t>(encoding.component_count));
  if (basis_size == 0) return;
  const PointsByCluster sorted = sort_by_cluster(encoding.cluster_of_point, cluster_count);
  parallel_for(cluster_count, 1, [&](std::size_t k, std::size_t) {
    const Subspace subspace{encoding.mean(static_cast<int>(k)),
                            std::span(encoding.bases).subspan(k * basis_size, basis_size)};
    find_components(signal, sorted.of(k), subspace, point_weights);
    project(signal, sorted.of(k), subspace, encoding.weights);
  });
}

void fit_weights(std::span<const float> signal, Encoding& encoding) {
  const auto n = static_cast<std::size_t>(encoding.dimension);
  const auto cluster_count = static_cast<std::size_t>(encoding.cluster_count);
  const auto count = static_cast<std::size_t>(encoding.component_count);
  encoding.weights.resize(encoding.point_count * count);
  const PointsByCluster sorted = sort_by_cluster(encoding.cluster_of_point, cluster_count);
  parallel_for(cluster_count, 1, [&](std::size_t k, std::size_t) {
    const std::span<float> basis = std::span(encoding.bases).subspan(k * count * n, count * n);
    project(signal, sorted.of(k), {encoding.mean(static_cast<int>(k)), basis}, encoding.weights);
  });
}

Encoding fit(std::span<const float> signal, int dimension, std::vector<std::uint32_t> labels,
             const Options& options) {
  Encoding encoding{
      .point_count = labels.size(),
      .dimension = dimension,
      .cluster_count = options.cluster_count,
      .component_count = options.component_count,
      .means = fit_means(signal, static_cast<std::size_t>(dimension), labels,
                         static_cast<std::size_t>(options.cluster_count), options.point_weights),
      .bases = {},
      .cluster_of_point = std::move(labels),
      .weights = {}};
  fit_components(signal, options.point_weights, encoding);
  return encoding;
}

}  // namespace prt::cpca
