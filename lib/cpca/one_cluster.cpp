#include "cpca/one_cluster.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "cpca/cluster_pca.h"
#include "cpca/fit.h"

namespace prt::cpca {

namespace {

/// Points whose weights are in memory at a time.
constexpr std::size_t kWeighed = 8192;

}  // namespace

OneCluster measure_one_cluster(std::span<const float> signal, std::size_t dimension,
                               int component_count, Norm norm,
                               std::span<const float> point_weights) {
  const std::size_t n = dimension, point_count = signal.size() / n,
                    count = static_cast<std::size_t>(component_count);
  std::vector<std::uint32_t> points(point_count, 0);
  Encoding part{.dimension = static_cast<int>(n),
                .cluster_count = 1,
                .component_count = component_count,
                .means = fit_means(signal, n, points, 1, point_weights),
                .bases = std::vector<float>(count * n),
                .cluster_of_point = {},
                .weights = {}};
  std::iota(points.begin(), points.end(), 0u);
  if (count > 0) find_components(signal, points, {part.means, part.bases}, point_weights);
  std::vector<double> errors(count + 1);
  for (std::size_t begin = 0; begin < point_count; begin += kWeighed) {
    part.point_count = std::min(kWeighed, point_count - begin);
    part.cluster_of_point.assign(part.point_count, 0);
    const auto rows = signal.subspan(begin * n, part.point_count * n);
    const auto weights =
        point_weights.empty() ? point_weights : point_weights.subspan(begin, part.point_count);
    fit_weights(rows, part);
    const std::vector<double> more = combined_errors(part, rows, norm, weights);
    for (std::size_t i = 0; i <= count; ++i) {
      errors[i] = norm == Norm::rmse ? errors[i] + more[i] : std::max(errors[i], more[i]);
    }
  }
  const double energy = weighted_energy(signal, point_count, point_weights);
  for (double& error : errors) error = relative(error, norm, point_count, energy);
  OneCluster result{.errors = std::move(errors)};
  const double numbers = static_cast<double>(signal.size());
  result.flops = 2.0 * numbers;
  if (count > 0) {
    result.flops += 2.0 * numbers * static_cast<double>(count + std::min(point_count, n));
  }
  return result;
}

}  // namespace prt::cpca
