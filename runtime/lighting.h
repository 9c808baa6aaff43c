// Light as the runtime takes it: the spherical harmonics that light the model, and the map that
// stands behind it.
#pragma once

#include <filesystem>
#include <optional>

#include "core/vec.h"
#include "image/image.h"
#include "sh/window.h"

namespace prt::runtime {

struct Lighting {
  sh::Light light;
  image::Image environment;  ///< latitude-longitude, 3 channels, what the background shows
  bool is_full_map = false;  ///< `environment` is the file's map, not the band-limited light's
};

/// Whether a path names a light file rather than an environment map.
bool is_light_file(const std::filesystem::path& path);

/// A light file (.json), shown behind the model as band limited as it lights; or an environment map
/// (any other file), shown in full and projected to `band_count` bands. Throws Error (bad_input).
Lighting load_lighting(const std::filesystem::path& path, int band_count);

/// A given light, its background drawn from its coefficients.
Lighting lighting_from(sh::Light light);

/// Damps what lights the model; what stands behind it stays as sharp as it was. Unset: none, with a
/// warning where more than 5% of the directions ring, unless it is the usual lamp.
sh::WindowedLight damp(Lighting& lighting, std::optional<sh::Window> window, bool is_lamp);

/// When none is given: a warm lamp on the left, above and in front, and a dim sky.
sh::Light default_light(int band_count);

/// A rotation turned on about an axis through the origin, and made a rotation again: products of
/// many rotations drift.
Matrix4 turned(const Matrix4& rotation, const Vec3& axis, float radians);

/// Turns light about +Y, counter-clockwise seen from above.
Matrix4 light_rotation(float degrees);

}  // namespace prt::runtime
