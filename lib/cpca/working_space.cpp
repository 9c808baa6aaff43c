#include "cpca/working_space.h"

#include <algorithm>

namespace prt::cpca {

namespace {

/// Signals of fewer coefficients are taken as they are: half as many axes leave out what tells near
/// clusters apart, and spare little.
constexpr std::size_t kLeastDimension = 128;
/// Of the error, what may lie outside the coordinates in use where there are more axes, and where
/// there are none left.
constexpr double kTail = 0.05, kLastTail = 0.25;
/// Errors below this share of the variance are no longer told by coordinates of single precision.
constexpr double kLeastError = 1e-5;
/// The error of vector quantisation, as a share of the variance, for the first choice.
constexpr double kFirstError = 0.1;

}  // namespace

WorkingSpace::WorkingSpace(std::span<const float> signal, std::size_t dimension,
                           std::span<const float> weights, bool axes)
    : signal_(signal),
      signal_dimension_(dimension),
      rows_{signal.data(), signal.size() / dimension, dimension, weights},
      dimension_(dimension) {
  if (!axes || dimension < kLeastDimension) return;
  // Nearly half as many as coefficients, of half their size.
  const std::size_t count = (dimension * 15 / 32 + 8) / 16 * 16;
  axes_ = find_principal_axes(signal, dimension, count, weights);
  rows_.values = nullptr;
  rows_.shorts = axes_.rows.data();
  rows_.scales = axes_.scales.data();
  rows_.stride = axes_.stride;
  fit_to(kFirstError * axes_.tails[0]);
}

bool WorkingSpace::fit_to(double error) {
  if (!has_axes()) return false;
  if (axes_.tails.back() > kLastTail * error || error < kLeastError * axes_.tails[0]) {
    return use_signal();
  }
  std::size_t count = 0;
  while (count < axes_.count() && axes_.tails[count] > kTail * error) ++count;
  dimension_ = std::max<std::size_t>(count, 1);
  return false;
}

bool WorkingSpace::use_signal() {
  if (!has_axes()) return false;
  axes_ = {};
  rows_ = signal_rows();
  dimension_ = signal_dimension_;
  return true;
}

void WorkingSpace::archive(Archive& archive) {
  bool uses_axes = has_axes();
  std::size_t dimension = dimension_;
  archive.value(uses_axes);
  archive.value(dimension);
  if (!uses_axes) use_signal();
  dimension_ = dimension;
}

std::vector<float> WorkingSpace::convert(std::span<const float> points) const {
  if (!has_axes()) return {points.begin(), points.end()};
  return to_axes(axes_, points);
}

}  // namespace prt::cpca
