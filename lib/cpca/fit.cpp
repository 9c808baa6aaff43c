#include "cpca/fit.h"

#include "core/parallel.h"
#include "cpca/cluster_pca.h"
#include "cpca/clusters.h"

namespace prt::cpca {

std::vector<float> fit_means(std::span<const float> signal, std::size_t dimension,
                             std::span<const std::uint32_t> labels, std::size_t cluster_count) {
  const PointsByCluster sorted = sort_by_cluster(labels, cluster_count);
  std::vector<float> means(cluster_count * dimension);
  parallel_for(cluster_count, 1, [&](std::size_t k, std::size_t) {
    const auto points = sorted.of(k);
    std::vector<double> sums(dimension);
    for (const std::uint32_t point : points) {
      const float* x = &signal[point * dimension];
      for (std::size_t i = 0; i < dimension; ++i) sums[i] += double{x[i]};
    }
    if (points.empty()) return;
    for (std::size_t i = 0; i < dimension; ++i) {
      means[k * dimension + i] = static_cast<float>(sums[i] / static_cast<double>(points.size()));
    }
  });
  return means;
}

void fit_components(std::span<const float> signal, Encoding& encoding) {
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
    find_components(signal, sorted.of(k), subspace);
    project(signal, sorted.of(k), subspace, encoding.weights);
  });
}

}  // namespace prt::cpca
