#include <chrono>

#include "core/parallel.h"
#include "cpca/cluster_pca.h"
#include "cpca/clusters.h"
#include "cpca/encoder.h"
#include "cpca/quantizer.h"
#include "cpca/seeding.h"

namespace prt::cpca {

namespace {

/// Times one call as a stage.
template <class Work>
void stage(Encoded& encoded, const char* name, const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  encoded.stages.push_back({name, elapsed.count()});
}

void find_subspaces(std::span<const float> signal, Encoding& encoding) {
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

}  // namespace

Encoded encode_static(std::span<const float> signal, int dimension, const Options& options) {
  check_options(options);
  check_signal(signal, dimension, options);
  const auto n = static_cast<std::size_t>(dimension);
  Encoded encoded;
  encoded.encoding.point_count = signal.size() / n;
  encoded.encoding.dimension = dimension;
  encoded.encoding.cluster_count = options.cluster_count;
  encoded.encoding.component_count = options.component_count;
  std::vector<float> means;
  stage(encoded, "seeding", [&] {
    means = seed_means(signal, n, static_cast<std::size_t>(options.cluster_count), options.seed);
  });
  stage(encoded, "clustering", [&] {
    Clustering clustering = quantize(signal, n, std::move(means), options.iterations);
    encoded.encoding.means = std::move(clustering.means);
    encoded.encoding.cluster_of_point = std::move(clustering.labels);
    encoded.iterations = clustering.iterations;
  });
  stage(encoded, "components", [&] { find_subspaces(signal, encoded.encoding); });
  return encoded;
}

}  // namespace prt::cpca
