#include "runtime/light_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "sh/light_edit.h"

namespace prt::runtime {

namespace {

[[noreturn]] void reject(std::span<const float> numbers, const char* expected) {
  throw Error(ErrorKind::usage, "no light near the model",
              {.found = fmt::format("{}", fmt::join(numbers, ",")), .expected = expected});
}

sh::Light light_at(const NearLight& light, int band_count, const Vec3& point) {
  const Vec3 to_light = light.position - point;
  const float distance = to_light.length();
  if (light.radius > 0.0f) {
    if (distance <= light.radius) return sh::constant_light(band_count, light.color);
    return sh::disk_light(band_count, to_light / distance, std::asin(light.radius / distance),
                          light.color);
  }
  if (distance == 0.0f) return sh::Light(band_count);  // from no direction
  return sh::directional_light(band_count, to_light / distance,
                               light.color / (distance * distance));
}

}  // namespace

NearLight near_light(std::span<const float> numbers) {
  if (numbers.size() != 6 && numbers.size() != 7)
    reject(numbers, "X,Y,Z,R,G,B or X,Y,Z,RADIUS,R,G,B");
  for (const float number : numbers)
    if (!std::isfinite(number)) reject(numbers, "finite numbers");
  const Vec3 position(numbers[0], numbers[1], numbers[2]);
  if (numbers.size() == 6) return {position, 0.0f, Vec3(numbers[3], numbers[4], numbers[5])};
  if (!(numbers[3] > 0.0f)) reject(numbers, "a positive radius");
  return {position, numbers[3], Vec3(numbers[4], numbers[5], numbers[6])};
}

sh::Light light_at(std::span<const NearLight> lights, int band_count, const Vec3& point) {
  sh::Light light(band_count);
  for (const NearLight& one : lights) light = sh::sum(light, light_at(one, band_count, point));
  return light;
}

std::size_t LightGrid::point_count() const { return static_cast<std::size_t>(size * size * size); }

Vec3 LightGrid::place(std::size_t number) const {
  const auto n = static_cast<std::size_t>(size);
  return {static_cast<float>(number % n), static_cast<float>(number / n % n),
          static_cast<float>(number / (n * n))};
}

Vec3 LightGrid::point(std::size_t number) const {
  if (size == 1) return (low + high) * 0.5f;
  return low + (high - low) * place(number) / static_cast<float>(size - 1);
}

Vec3 LightGrid::steps_per_unit() const {
  Vec3 scale(0.0f);  // along a side without extent all points are the first
  for (int axis = 0; axis < 3; ++axis)
    if (high[axis] > low[axis])
      scale[axis] = static_cast<float>(size - 1) / (high[axis] - low[axis]);
  return scale;
}

void LightGrid::bind(const gl::Program& program) const {
  program.set("u_grid_size", size);
  program.set("u_grid_corner", low);
  program.set("u_grid_scale", steps_per_unit());
}

LightField light_field(const sh::Light& distant, std::span<const NearLight> near,
                       const LightGrid& grid) {
  if (near.empty()) return {{}, {distant}};
  LightField field{grid, {}};
  for (std::size_t i = 0; i < grid.point_count(); ++i)
    field.samples.push_back(sh::sum(distant, light_at(near, distant.band_count, grid.point(i))));
  return field;
}

gl::Defines light_field_defines(bool varies) {
  return {fmt::format("LIGHT_SAMPLE_COUNT {}", varies ? 8 : 1)};
}

sh::Light light_in(const LightField& field, const Vec3& point) {
  if (!field.varies()) return field.samples.front();
  const int size = field.grid.size;
  const Vec3 scale = field.grid.steps_per_unit();
  int cell[3];
  float high[3];
  for (int axis = 0; axis < 3; ++axis) {
    const float place = std::clamp((point[axis] - field.grid.low[axis]) * scale[axis], 0.0f,
                                   static_cast<float>(size - 1));
    cell[axis] = std::min(static_cast<int>(place), size - 2);
    high[axis] = place - static_cast<float>(cell[axis]);
  }
  sh::Light light(field.samples.front().band_count);
  for (int corner = 0; corner < 8; ++corner) {
    float share = 1.0f;
    int number = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const int side = corner >> axis & 1;
      share *= side == 1 ? high[axis] : 1.0f - high[axis];
      number = number * size + cell[axis] + side;
    }
    const sh::Light& sample = field.samples[static_cast<std::size_t>(number)];
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < light.coefficients[c].size(); ++k)
        light.coefficients[c][k] += share * sample.coefficients[c][k];
  }
  return light;
}

}  // namespace prt::runtime
