#include "sh/light.h"

#include <cassert>
#include <cmath>
#include <numbers>

#include "sh/basis.h"
#include "sh/rotation.h"
#include "sh/zonal.h"

namespace prt::sh {

namespace {

// The same function of direction in every channel, times the channel's colour.
Light tinted(std::span<const double> coefficients, int band_count, const Vec3& colour) {
  Light light(band_count);
  for (int c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < coefficients.size(); ++i) {
      light.coefficients[static_cast<std::size_t>(c)][i] =
          static_cast<float>(coefficients[i] * double{colour[c]});
    }
  }
  return light;
}

std::vector<double> basis_at(int band_count, const Vec3& direction) {
  std::vector<double> values(row_size(band_count));
  evaluate(band_count, direction.x, direction.y, direction.z, values);
  return values;
}

}  // namespace

Light::Light(int bands) : band_count(bands) {
  assert(bands >= 0 && bands <= kMaxBandCount);
  for (auto& channel : coefficients) {
    channel.resize(row_size(bands));
  }
}

Vec3 light_radiance(const Light& light, const Vec3& direction) {
  const std::vector<double> values = basis_at(light.band_count, direction);
  Vec3 radiance;
  for (int c = 0; c < 3; ++c) {
    const std::vector<float>& channel = light.coefficients[static_cast<std::size_t>(c)];
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += values[i] * double{channel[i]};
    radiance[c] = static_cast<float>(sum);
  }
  return radiance;
}

Light with_band_count(const Light& light, int band_count) {
  Light result = light;
  result.band_count = band_count;
  for (auto& channel : result.coefficients) {
    channel.resize(row_size(band_count));
  }
  return result;
}

Light constant_light(int band_count, const Vec3& radiance) {
  const double value = std::sqrt(4 * std::numbers::pi);
  return tinted(std::span(&value, band_count > 0 ? 1 : 0), band_count, radiance);
}

Light disk_light(int band_count, const Vec3& direction, float radius, const Vec3& radiance) {
  std::vector<double> coefficients(row_size(band_count));
  turn_lobe(disk_lobe(band_count, radius), direction, coefficients);
  return tinted(coefficients, band_count, radiance);
}

Light directional_light(int band_count, const Vec3& direction, const Vec3& irradiance) {
  return tinted(basis_at(band_count, direction), band_count, irradiance);
}

Light rotated(const Light& light, const Matrix4& world_from_light) {
  const Rotation rotation(light.band_count, world_from_light);
  Light result = light;
  for (std::size_t c = 0; c < 3; ++c) {
    rotation.apply(light.coefficients[c], result.coefficients[c]);
  }
  return result;
}

}  // namespace prt::sh
