// Real spherical harmonics, orthonormal, with the Condon-Shortley phase: index l(l+1)+m, m = -l..l;
// Y(1,-1) = -0.4886 y, Y(1,0) = +0.4886 z, Y(1,1) = -0.4886 x. `band_count` bands are l = 0 ..
// band_count-1, band_count² coefficients.
#pragma once

#include <cstddef>
#include <span>

#include "core/vec.h"

namespace prt::sh {

constexpr int kMaxBandCount = 16;

constexpr int coefficient_count(int band_count) { return band_count * band_count; }
/// The same, as the length of a row.
constexpr std::size_t row_size(int band_count) {
  return static_cast<std::size_t>(coefficient_count(band_count));
}
constexpr int coefficient_index(int l, int m) { return l * (l + 1) + m; }

/// All coefficient_count(band_count) values at one unit direction.
void evaluate(int band_count, const Vec3& direction, std::span<float> values);

/// The same in double precision.
void evaluate(int band_count, double x, double y, double z, std::span<double> values);

/// Many directions at once, in single precision: within 2e-6 of evaluate() relative to the largest
/// value of the band. Planar in and out: coordinate arrays of `count` floats, and
/// values[i * stride + d] is coefficient i at direction d. stride >= count.
void evaluate_batch(int band_count, const float* x, const float* y, const float* z,
                    std::size_t count, float* values, std::size_t stride);

/// Σ_i coefficients[i] Y_i(direction).
float evaluate_sum(int band_count, std::span<const float> coefficients, const Vec3& direction);

}  // namespace prt::sh
