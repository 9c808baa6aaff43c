#include "cpca/search_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "cpca/error_limits.h"

namespace prt::cpca {

namespace {

constexpr std::size_t kErrorBlock = 512;

std::size_t total(const StorageCost& cost, const Size& size, std::size_t weight_count,
                  std::size_t cluster_count, std::size_t vector_count) {
  return cost.bytes_of_headers + size.point_count * cost.bytes_per_point +
         weight_count * cost.bytes_per_weight + cluster_count * cost.bytes_per_cluster +
         (cluster_count + vector_count) * size.dimension * sizeof(float);
}

std::size_t padded(std::size_t weight_count, std::size_t group) {
  return (weight_count + group - 1) / group * group;
}

double combine(std::span<const double> weighted_errors, Norm norm) {
  return norm == Norm::rmse ? std::accumulate(weighted_errors.begin(), weighted_errors.end(), 0.0)
                            : *std::max_element(weighted_errors.begin(), weighted_errors.end());
}

}  // namespace

std::size_t StorageCost::bytes(const Size& size, const Choice& choice) const {
  const auto clusters = static_cast<std::size_t>(choice.cluster_count);
  const auto components = static_cast<std::size_t>(choice.component_count);
  return total(*this, size, size.point_count * padded(components, weight_group), clusters,
               clusters * components);
}

std::size_t StorageCost::bytes(const Encoding& encoding) const {
  std::size_t weights = 0, vectors = 0;
  const auto count_of = [&](int cluster) {
    return static_cast<std::size_t>(encoding.component_count_of(cluster));
  };
  for (int k = 0; k < encoding.cluster_count; ++k) vectors += count_of(k);
  for (const std::uint32_t cluster : encoding.cluster_of_point) {
    weights += padded(count_of(static_cast<int>(cluster)), weight_group);
  }
  return total(*this, {encoding.point_count, static_cast<std::size_t>(encoding.dimension)}, weights,
               static_cast<std::size_t>(encoding.cluster_count), vectors);
}

Choice StorageCost::whole(const Size& size) const {
  return {1, std::min(static_cast<int>(size.dimension), max_component_count)};
}

std::size_t StorageCost::enough_bytes(const Size& size) const {
  return std::max(bytes_of_headers + size.point_count * size.dimension * sizeof(float),
                  bytes(size, whole(size)));
}

std::size_t Bound::most_bytes(const Size& size) const {
  const std::size_t enough = cost.enough_bytes(size);
  return max_bytes ? std::min(*max_bytes, enough) : 2 * enough;
}

void Bound::check_room(const Size& size) const {
  if (cost.bytes(size, {1, 0}) <= most_bytes(size)) return;
  throw_failed("no encoding is as small",
               {.found = fmt::format("at least {} bytes", cost.bytes(size, {1, 0})),
                .expected = fmt::format("at most {}", most_bytes(size))});
}

double weighted_energy(std::span<const float> signal, std::size_t point_count,
                       std::span<const float> point_weights) {
  const std::size_t n = signal.size() / point_count;
  std::vector<double> sums(block_count(point_count, kErrorBlock));
  parallel_for(point_count, kErrorBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      double lanes[8] = {};
      for (std::size_t i = 0; i < n; ++i) {
        const double value = signal[p * n + i];
        lanes[i % 8] += value * value;
      }
      double square = 0.0;
      for (const double lane : lanes) square += lane;
      sums[begin / kErrorBlock] +=
          square * (point_weights.empty() ? 1.0 : double{point_weights[p]});
    }
  });
  double sum = 0.0;
  for (const double part : sums) sum += part;
  return sum;
}

double relative(double error, Norm norm, std::size_t point_count, double energy) {
  if (energy <= 0.0) return 0.0;
  return std::sqrt(error * (norm == Norm::rmse ? 1.0 : static_cast<double>(point_count)) / energy);
}

double relative_error(const Encoding& encoding, std::span<const float> signal, Norm norm,
                      std::span<const float> point_weights) {
  const double energy = weighted_energy(signal, encoding.point_count, point_weights);
  const std::vector<double> errors = weighted_errors(encoding, signal, point_weights);
  return relative(combine(errors, norm), norm, errors.size(), energy);
}

std::vector<double> combined_errors(const Encoding& encoding, std::span<const float> signal,
                                    Norm norm, std::span<const float> point_weights) {
  const auto count = static_cast<std::size_t>(encoding.component_count);
  std::vector<double> errors = weighted_errors(encoding, signal, point_weights);
  std::vector<double> combined(count + 1);
  for (std::size_t i = count + 1; i-- > 0;) {
    combined[i] = combine(errors, norm);
    for (std::size_t p = 0; i > 0 && p < errors.size(); ++p) {
      const double weight = encoding.weights[p * count + i - 1];
      errors[p] += weight * weight * (point_weights.empty() ? 1.0 : double{point_weights[p]});
    }
  }
  return combined;
}

std::vector<double> relative_errors(const Encoding& encoding, std::span<const float> signal,
                                    Norm norm, std::span<const float> point_weights) {
  const double energy = weighted_energy(signal, encoding.point_count, point_weights);
  std::vector<double> errors = combined_errors(encoding, signal, norm, point_weights);
  for (double& error : errors) error = relative(error, norm, encoding.point_count, energy);
  return errors;
}

}  // namespace prt::cpca
