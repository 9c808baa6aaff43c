#include "sh/light_edit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sh/basis.h"
#include "sh/projection.h"

namespace prt::sh {

namespace {

using std::numbers::pi;
constexpr int kGridHeight = 90;

Matrix4 rotation_matrix(const Vec3& degrees) {
  Matrix4 matrix;  // row vectors: the first factor acts first
  const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int i = 0; i < 3; ++i) {
    Matrix4 turn;
    turn.setAxisAngle(axes[i], static_cast<float>(double{degrees[i]} * pi / 180));
    matrix = matrix * turn;
  }
  return matrix;
}

}  // namespace

Light edited(const Light& light, const LightEdit& edit) {
  Light result = edit.rotation == Vec3(0) ? light : rotated(light, rotation_matrix(edit.rotation));
  const auto gain = static_cast<float>(std::exp2(double{edit.exposure}));
  for (auto& channel : result.coefficients)
    for (float& value : channel) value *= gain;
  return result;
}

Light sum(const Light& a, const Light& b) {
  const int band_count = std::max(a.band_count, b.band_count);
  Light result = with_band_count(a, band_count);
  const Light other = with_band_count(b, band_count);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < result.coefficients[c].size(); ++i) {
      result.coefficients[c][i] += other.coefficients[c][i];
    }
  }
  if (!a.source.empty() && !b.source.empty()) result.source += " + ";
  result.source += b.source;
  return result;
}

LightStatistics statistics_of(const Light& light) {
  LightStatistics statistics;
  for (int l = 0; l < light.band_count; ++l) {
    double energy = 0;
    for (const auto& channel : light.coefficients) {
      for (int m = -l; m <= l; ++m) {
        const double value = double{channel[static_cast<std::size_t>(coefficient_index(l, m))]};
        energy += value * value;
      }
    }
    statistics.band_energy.push_back(energy);
    statistics.energy += energy;
  }
  const int width = 2 * kGridHeight;
  double negative = 0, minimum = INFINITY, maximum = -INFINITY;
  for (int y = 0; y < kGridHeight; ++y) {
    const double latitude = pi * (0.5 - (y + 0.5) / kGridHeight);
    const double solid_angle = texel_solid_angle(width, kGridHeight, y);
    for (int x = 0; x < width; ++x) {
      const double longitude = 2 * pi * (x + 0.5) / width;
      const Vec3 radiance =
          light_radiance(light, Vec3(static_cast<float>(std::sin(longitude) * std::cos(latitude)),
                                     static_cast<float>(std::sin(latitude)),
                                     static_cast<float>(std::cos(longitude) * std::cos(latitude))));
      const double luminance = double{radiance.dot(Vec3(0.2126f, 0.7152f, 0.0722f))};
      minimum = std::min(minimum, luminance);
      maximum = std::max(maximum, luminance);
      if (luminance < 0) negative += solid_angle;
    }
  }
  statistics.minimum_luminance = minimum;
  statistics.maximum_luminance = maximum;
  statistics.negative_fraction = negative / (4 * pi);
  return statistics;
}

}  // namespace prt::sh
