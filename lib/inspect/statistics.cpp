#include "inspect/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace prt::inspect {

Json range_of(std::span<const float> values) {
  double low = INFINITY, high = -INFINITY, sum = 0.0;
  std::size_t count = 0;
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min<double>(low, value);
    high = std::max<double>(high, value);
    sum += value;
    ++count;
  }
  if (count == 0) return Json::object();
  return {{"min", low}, {"max", high}, {"mean", sum / static_cast<double>(count)}};
}

double percentile(std::vector<double>& values, double share) {
  assert(!values.empty());
  const double rank = std::ceil(share * static_cast<double>(values.size())) - 1.0;
  const auto index = static_cast<std::ptrdiff_t>(std::max(rank, 0.0));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

Json percentiles_of(std::vector<double> values) {
  if (values.empty()) return Json::object();
  return {{"p50", percentile(values, 0.5)},
          {"p90", percentile(values, 0.9)},
          {"p99", percentile(values, 0.99)},
          {"max", percentile(values, 1.0)}};
}

std::size_t count_non_finite(std::span<const float> values) {
  return static_cast<std::size_t>(std::count_if(values.begin(), values.end(),
                                                [](float value) { return !std::isfinite(value); }));
}

}  // namespace prt::inspect
