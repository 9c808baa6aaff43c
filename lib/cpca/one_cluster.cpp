#include "cpca/one_cluster.h"

#include <algorithm>
#include <cmath>
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
  std::vector<double> squares(count + 1);
  for (std::size_t begin = 0; begin < point_count; begin += kWeighed) {
    part.point_count = std::min(kWeighed, point_count - begin);
    part.cluster_of_point.assign(part.point_count, 0);
    const auto rows = signal.subspan(begin * n, part.point_count * n);
    const auto weights =
        point_weights.empty() ? point_weights : point_weights.subspan(begin, part.point_count);
    fit_weights(rows, part);
    const std::vector<double> errors = relative_errors(part, rows, norm, weights);
    const double energy = weighted_energy(rows, part.point_count, weights);
    for (std::size_t i = 0; i <= count; ++i) {
      const double square = errors[i] * errors[i] * energy;
      squares[i] = norm == Norm::rmse
                       ? squares[i] + square
                       : std::max(squares[i], square / static_cast<double>(part.point_count));
    }
  }
  const double energy = weighted_energy(signal, point_count, point_weights);
  const double share = norm == Norm::rmse ? 1.0 : static_cast<double>(point_count);
  OneCluster result;
  for (const double square : squares) {
    result.errors.push_back(energy > 0.0 ? std::sqrt(share * square / energy) : 0.0);
  }
  const double numbers = static_cast<double>(signal.size());
  result.flops = 2.0 * numbers;
  if (count > 0) {
    result.flops += 2.0 * numbers * static_cast<double>(count + std::min(point_count, n));
  }
  return result;
}

}  // namespace prt::cpca
