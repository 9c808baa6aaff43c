#include "sh/basis.h"

#include <cassert>

#include "sh/recurrence.h"

namespace prt::sh {

void evaluate(int band_count, double x, double y, double z, std::span<double> values) {
  assert(band_count >= 0 && band_count <= kMaxBandCount);
  assert(values.size() >= row_size(band_count));
  evaluate_lanes<double>(band_count, x, y, z,
                         [&](int i, double value) { values[static_cast<std::size_t>(i)] = value; });
}

void evaluate(int band_count, const Vec3& direction, std::span<float> values) {
  assert(band_count >= 0 && band_count <= kMaxBandCount);
  assert(values.size() >= row_size(band_count));
  evaluate_lanes<double>(band_count, double{direction.x}, double{direction.y}, double{direction.z},
                         [&](int i, double value) {
                           values[static_cast<std::size_t>(i)] = static_cast<float>(value);
                         });
}

float evaluate_sum(int band_count, std::span<const float> coefficients, const Vec3& direction) {
  assert(coefficients.size() >= row_size(band_count));
  double sum = 0;
  evaluate_lanes<double>(band_count, double{direction.x}, double{direction.y}, double{direction.z},
                         [&](int i, double value) {
                           sum += value * double{coefficients[static_cast<std::size_t>(i)]};
                         });
  return static_cast<float>(sum);
}

}  // namespace prt::sh
