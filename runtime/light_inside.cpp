#include "runtime/light_inside.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/log.h"

namespace prt::runtime {

namespace {

using Vec3d = Imath::V3d;

bool is_inside(const Model& model, const NearLight& light) {
  if ((light.position - model.bounds.center).length() > model.bounds.radius) return false;
  const bool reaches = std::ranges::any_of(
      model.positions, [&](const Vec3& p) { return (p - light.position).length() < light.radius; });
  return !reaches && winding_number(model, light.position) > 0.5;
}

}  // namespace

double winding_number(const Model& model, const Vec3& point) {
  double half_angles = 0.0;
  for (std::size_t i = 0; i + 2 < model.indices.size(); i += 3) {
    Vec3d corners[3];
    for (std::size_t c = 0; c < 3; ++c)
      corners[c] = Vec3d(model.positions[model.indices[i + c]]) - Vec3d(point);
    const auto& [a, b, c] = corners;
    const double la = a.length(), lb = b.length(), lc = c.length();
    half_angles +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return half_angles / (2.0 * std::numbers::pi);
}

void warn_of_lights_inside(const Model& model, std::span<const NearLight> lights) {
  for (const NearLight& light : lights) {
    if (!is_inside(model, light)) continue;
    log::warning(
        "the light at {},{},{} is inside of the model, which it leaves black, or nearly so: its "
        "triangles face outward. Move it outside",
        light.position.x, light.position.y, light.position.z);
  }
}

}  // namespace prt::runtime
