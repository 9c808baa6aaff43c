#include "runtime/lighting.h"

#include <ImathMatrixAlgo.h>

#include <array>
#include <numbers>
#include <vector>

#include "core/file.h"
#include "core/log.h"
#include "core/parallel.h"
#include "image/environment.h"
#include "sh/basis.h"
#include "sh/light_edit.h"

namespace prt::runtime {

namespace {

// Bilinear interpolation errs by at most (pi / height)² l² / 8 of the highest band l: 0.2% at l
// = 9.
constexpr int kBackgroundHeight = 256;

image::Image image_of(const sh::Light& light) {
  image::Image map(2 * kBackgroundHeight, kBackgroundHeight, 3);
  const auto width = static_cast<std::size_t>(map.width);
  const auto coefficient_count = static_cast<std::size_t>(sh::coefficient_count(light.band_count));
  parallel_for(kBackgroundHeight, 16, [&](std::size_t begin, std::size_t end) {
    std::array<std::vector<float>, 3> direction;
    for (std::vector<float>& axis : direction) axis.resize(width);
    std::vector<float> basis(coefficient_count * width);
    for (std::size_t y = begin; y < end; ++y) {
      for (std::size_t x = 0; x < width; ++x) {
        const Vec3 d = image::direction_from_latlong(
            (static_cast<float>(x) + 0.5f) / static_cast<float>(width),
            (static_cast<float>(y) + 0.5f) / static_cast<float>(kBackgroundHeight));
        for (int axis = 0; axis < 3; ++axis) direction[static_cast<std::size_t>(axis)][x] = d[axis];
      }
      sh::evaluate_batch(light.band_count, direction[0].data(), direction[1].data(),
                         direction[2].data(), width, basis.data(), width);
      float* const row = map.at(0, static_cast<int>(y));
      for (std::size_t k = 0; k < coefficient_count; ++k)
        for (std::size_t x = 0; x < width; ++x)
          for (std::size_t c = 0; c < 3; ++c)
            row[3 * x + c] += light.coefficients[c][k] * basis[k * width + x];
    }
  });
  return map;
}

}  // namespace

Lighting lighting_from(sh::Light light) {
  image::Image environment = image_of(light);
  return {std::move(light), std::move(environment), false};
}

bool is_light_file(const std::filesystem::path& path) { return lower_extension(path) == ".json"; }

Lighting load_lighting(const std::filesystem::path& path, int band_count) {
  if (is_light_file(path)) return lighting_from(sh::read_light(path));
  image::Image map = image::read_environment(path);
  sh::Light light = sh::project_environment(band_count, map.width, map.height, map.pixels.data());
  return {std::move(light), std::move(map), true};
}

sh::WindowedLight damp(Lighting& lighting, std::optional<sh::Window> window, bool is_lamp) {
  constexpr double kMostNegative = 0.05;
  sh::WindowedLight damped = sh::windowed(lighting.light, window.value_or(sh::Window::none));
  lighting.light = damped.light;
  if (!window && !is_lamp && damped.ringing.negative_fraction > kMostNegative)
    log::warning(
        "the light rings: negative over {:.0f}% of the sphere, down to {:.2g} of its mean; "
        "--window auto damps it",
        100 * damped.ringing.negative_fraction, damped.ringing.minimum_over_mean);
  return damped;
}

sh::Light default_light(int band_count) {
  constexpr float kLampRadius = 0.35f;  // radians
  const sh::Light sky = sh::constant_light(band_count, Vec3(0.25f, 0.28f, 0.33f));
  const sh::Light lamp = sh::disk_light(band_count, Vec3(-1.0f, 1.2f, 1.0f).normalized(),
                                        kLampRadius, Vec3(7.0f, 6.5f, 5.8f));
  sh::Light light = sh::sum(sky, lamp);
  light.source = "prtkit's lamp";
  return light;
}

Matrix4 turned(const Matrix4& rotation, const Vec3& axis, float radians) {
  Matrix4 turn;
  turn.setAxisAngle(axis, radians);
  return Imath::extractQuat(rotation * turn).normalized().toMatrix44();
}

Matrix4 light_rotation(float degrees) {
  Matrix4 world_from_light;
  world_from_light.setAxisAngle(Vec3(0, 1, 0), degrees * std::numbers::pi_v<float> / 180.0f);
  return world_from_light;
}

}  // namespace prt::runtime
