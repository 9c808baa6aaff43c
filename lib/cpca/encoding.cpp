#include "cpca/encoding.h"

#include <algorithm>
#include <cassert>

#include "core/parallel.h"
#include "cpca/distance.h"

namespace prt::cpca {

namespace {
constexpr std::size_t kBlock = 256;
}

int Encoding::component_count_of(int cluster) const {
  return component_counts.empty()
             ? component_count
             : static_cast<int>(component_counts[static_cast<std::size_t>(cluster)]);
}

std::span<const float> Encoding::mean(int cluster) const {
  const auto n = static_cast<std::size_t>(dimension);
  return {&means[static_cast<std::size_t>(cluster) * n], n};
}

std::span<const float> Encoding::basis(int cluster, int component) const {
  const auto n = static_cast<std::size_t>(dimension);
  const std::size_t row =
      static_cast<std::size_t>(cluster) * static_cast<std::size_t>(component_count) +
      static_cast<std::size_t>(component);
  return {&bases[row * n], n};
}

void reconstruct(const Encoding& encoding, std::size_t point, std::span<float> row) {
  assert(row.size() == static_cast<std::size_t>(encoding.dimension));
  const auto cluster = static_cast<int>(encoding.cluster_of_point[point]);
  const std::span<const float> mean = encoding.mean(cluster);
  std::copy(mean.begin(), mean.end(), row.begin());
  for (int i = 0; i < encoding.component_count_of(cluster); ++i) {
    const std::span<const float> basis = encoding.basis(cluster, i);
    const float weight =
        encoding.weights[point * static_cast<std::size_t>(encoding.component_count) +
                         static_cast<std::size_t>(i)];
    for (std::size_t j = 0; j < row.size(); ++j) row[j] += weight * basis[j];
  }
}

std::vector<double> point_errors(const Encoding& encoding, std::span<const float> signal) {
  const auto n = static_cast<std::size_t>(encoding.dimension);
  assert(signal.size() == encoding.point_count * n);
  std::vector<double> errors(encoding.point_count);
  parallel_for(encoding.point_count, kBlock, [&](std::size_t begin, std::size_t end) {
    std::vector<float> row(n);
    for (std::size_t p = begin; p < end; ++p) {
      reconstruct(encoding, p, row);
      errors[p] = squared_distance(signal.subspan(p * n, n), row);
    }
  });
  return errors;
}

}  // namespace prt::cpca
