#include "cpca/figures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/parallel.h"

namespace prt::cpca {

namespace {

constexpr std::size_t kSumBlock = 1 << 16;

double energy(std::span<const float> values) {
  std::vector<double> sums(block_count(values.size(), kSumBlock));
  parallel_for(values.size(), kSumBlock, [&](std::size_t begin, std::size_t end) {
    double lanes[8] = {};
    for (std::size_t i = begin; i < end; ++i) lanes[i % 8] += double{values[i]} * double{values[i]};
    for (double lane : lanes) sums[begin / kSumBlock] += lane;
  });
  double sum = 0.0;
  for (double part : sums) sum += part;
  return sum;
}

}  // namespace

double Figures::relative_rmse() const {
  if (squared_error == 0.0) return 0.0;
  return signal_energy > 0.0 ? std::sqrt(squared_error / signal_energy)
                             : std::numeric_limits<double>::infinity();
}

Figures summarize(std::span<const double> errors, std::span<const float> rows) {
  Figures figures{.signal_energy = energy(rows)};
  for (double error : errors) {
    figures.squared_error += error;
    figures.max_point_error = std::max(figures.max_point_error, error);
  }
  return figures;
}

std::size_t storage_bytes(const Encoding& encoding) {
  std::vector<std::size_t> weight_counts(static_cast<std::size_t>(encoding.cluster_count));
  std::size_t numbers = encoding.means.size();
  for (int k = 0; k < encoding.cluster_count; ++k) {
    weight_counts[static_cast<std::size_t>(k)] =
        static_cast<std::size_t>(encoding.component_count_of(k));
    numbers +=
        weight_counts[static_cast<std::size_t>(k)] * static_cast<std::size_t>(encoding.dimension);
  }
  for (std::uint32_t cluster : encoding.cluster_of_point) numbers += weight_counts[cluster];
  const std::size_t index_bytes = encoding.cluster_count <= 65536 ? 2 : 4;
  return numbers * sizeof(float) + encoding.point_count * index_bytes;
}

}  // namespace prt::cpca
