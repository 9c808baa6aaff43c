#include "sh/analytic_light.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/error.h"

namespace prt::sh {

namespace {

const char* name_of(AnalyticKind kind) {
  switch (kind) {
    case AnalyticKind::constant:
      return "constant";
    case AnalyticKind::disk:
      return "disk";
    default:
      return "directional";
  }
}

[[noreturn]] void reject(AnalyticKind kind, const char* what, std::span<const float> numbers,
                         const std::string& expected) {
  throw Error(ErrorKind::usage, what,
              {.element = fmt::format("{} light", name_of(kind)),
               .found = fmt::format("{}", fmt::join(numbers, ",")),
               .expected = expected});
}

Vec3 vector_at(std::span<const float> numbers, std::size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

Vec3 direction_at(AnalyticKind kind, std::span<const float> numbers) {
  const Vec3 direction = vector_at(numbers, 0);
  if (direction == Vec3(0)) reject(kind, "no direction", numbers, "X,Y,Z other than 0,0,0");
  return Vec3(Imath::V3d(direction).normalized());  // floats would overflow, or vanish
}

}  // namespace

int number_count(AnalyticKind kind) {
  return kind == AnalyticKind::constant ? 3 : kind == AnalyticKind::disk ? 7 : 6;
}

Light analytic_light(AnalyticKind kind, int band_count, std::span<const float> numbers) {
  if (numbers.size() != static_cast<std::size_t>(number_count(kind))) {
    reject(kind, "wrong count", numbers, fmt::format("{} numbers", number_count(kind)));
  }
  for (float number : numbers) {
    if (!std::isfinite(number)) reject(kind, "bad number", numbers, "finite numbers");
  }
  Light light;
  if (kind == AnalyticKind::constant) {
    light = constant_light(band_count, vector_at(numbers, 0));
  } else if (kind == AnalyticKind::directional) {
    light = directional_light(band_count, direction_at(kind, numbers), vector_at(numbers, 3));
  } else {
    if (!(numbers[3] > 0 && numbers[3] <= 180)) {
      reject(kind, "bad radius", numbers, "a radius above 0, at most 180 degrees");
    }
    const float radius = numbers[3] * std::numbers::pi_v<float> / 180;
    light = disk_light(band_count, direction_at(kind, numbers), radius, vector_at(numbers, 4));
  }
  light.source = fmt::format("{} {}", name_of(kind), fmt::join(numbers, ","));
  return light;
}

}  // namespace prt::sh
