// The principal axes of a whole signal. Transfer lies near a space of few dimensions: encoders that
// compare points with subspaces time and again do it in the first axes only, where the rest adds
// the same known square to every error of a point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt::cpca {

struct PrincipalAxes {
  std::vector<float> mean;  ///< dimension; what the axes go out from
  std::vector<float> axes;  ///< count × dimension, orthonormal, largest variance first
  /// The points in these coordinates, point × stride: numbers of 16 bits, rounded, times the scale
  /// of the axis. Beside what encoders leave of a signal their rounding is nothing.
  std::vector<std::int16_t> rows;
  std::vector<float> scales;  ///< stride
  std::size_t stride = 0;     ///< count and some zeros
  /// count + 1: Σ_p weight_p ‖x_p - what the first i coordinates give‖²
  std::vector<double> tails;

  std::size_t count() const { return tails.size() - 1; }
};

/// The first `count` axes, of a sample of the points when there are many more than coefficients:
/// any axes will do, the nearer the faster. `weights`: of each point, or empty.
PrincipalAxes find_principal_axes(std::span<const float> signal, std::size_t dimension,
                                  std::size_t count, std::span<const float> weights);

/// Other points (any number × dimension) in the coordinates of the axes, stride apart.
std::vector<float> to_axes(const PrincipalAxes& axes, std::span<const float> points);

}  // namespace prt::cpca
