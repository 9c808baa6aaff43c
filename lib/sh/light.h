// Distant light as spherical harmonic coefficients of radiance, linear Rec. 709, world frame (+Y
// up).
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/vec.h"

namespace prt::sh {

struct Light {
  int band_count = 0;
  std::array<std::vector<float>, 3> coefficients;  ///< R, G, B: band_count² each
  std::string source;  ///< what it was made from, for people; may be empty

  explicit Light(int bands = 0);
};

/// Radiance that the band-limited light has in a direction; can be negative (ringing).
Vec3 light_radiance(const Light& light, const Vec3& direction);

/// The first `band_count` bands; missing ones are 0.
Light with_band_count(const Light& light, int band_count);

/// Constant radiance from everywhere.
Light constant_light(int band_count, const Vec3& radiance);
/// A disk of angular radius `radius` (radians) around a unit direction, constant radiance on it.
Light disk_light(int band_count, const Vec3& direction, float radius, const Vec3& radiance);
/// A directional light of unit direction (towards the light) and irradiance on a facing surface.
Light directional_light(int band_count, const Vec3& direction, const Vec3& irradiance);

/// Projects a latitude-longitude map (convention of image/environment.h; width × height × 3
/// floats), exact solid angle of each texel, constant radiance on it.
Light project_environment(int band_count, int width, int height, const float* rgb);

/// The light turned by a rotation matrix: what was seen in direction d is now in world_from_light
/// d.
Light rotated(const Light& light, const Matrix4& world_from_light);

/// Light files: JSON, see docs/light-file.md. Reading throws Error (bad_input).
Light read_light(const std::filesystem::path& path);
void write_light(const std::filesystem::path& path, const Light& light, bool no_clobber = false);

}  // namespace prt::sh
