#include "cpca/projection.h"

#include <algorithm>
#include <cassert>
#include <vector>

#include "cpca/distance.h"

namespace prt::cpca {

namespace {

/// Partial sums in a fixed order, so that the compiler may vectorise over them.
double dot(std::span<const float> a, std::span<const float> b) {
  double sums[kDistanceLanes] = {};
  std::size_t i = 0;
  for (; i + kDistanceLanes <= a.size(); i += kDistanceLanes) {
    for (std::size_t lane = 0; lane < kDistanceLanes; ++lane) {
      sums[lane] += double{a[i + lane]} * double{b[i + lane]};
    }
  }
  double sum = 0.0;
  for (const double part : sums) sum += part;
  for (; i < a.size(); ++i) sum += double{a[i]} * double{b[i]};
  return sum;
}

}  // namespace

double project_point(const Encoding& encoding, int cluster, std::span<const float> x,
                     std::span<float> weights) {
  assert(x.size() == static_cast<std::size_t>(encoding.dimension));
  assert(weights.size() == static_cast<std::size_t>(encoding.component_count));
  const std::span<const float> mean = encoding.mean(cluster);
  std::vector<float> offset(x.size()), row(mean.begin(), mean.end());
  for (std::size_t j = 0; j < x.size(); ++j) offset[j] = x[j] - mean[j];
  std::fill(weights.begin(), weights.end(), 0.0f);
  for (int i = 0; i < encoding.component_count_of(cluster); ++i) {
    const std::span<const float> basis = encoding.basis(cluster, i);
    const auto weight = static_cast<float>(dot(offset, basis));
    weights[static_cast<std::size_t>(i)] = weight;
    for (std::size_t j = 0; j < x.size(); ++j) row[j] += weight * basis[j];
  }
  return squared_distance(x, row);
}

}  // namespace prt::cpca
