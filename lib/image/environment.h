// Environment maps: latitude-longitude images of the radiance that arrives from infinity.
//
// Convention (that of OpenEXR, with glTF's +Y up): row 0 is the zenith, +Y. Column u in [0, 1]
// looks at longitude pi (1 - 2u), direction (sin(lon) cos(lat), sin(lat), cos(lon) cos(lat)): the
// image's middle is +Z, a quarter from the left is +X.
#pragma once

#include <filesystem>
#include <vector>

#include "core/vec.h"
#include "image/image.h"

namespace prt::image {

/// Unit direction of continuous texture coordinates in [0, 1]².
Vec3 direction_from_latlong(float u, float v);
/// Inverse of the above.
Vec2 latlong_from_direction(const Vec3& direction);

/// Three channels, finite, negative values (compression leaves some) clamped to 0, with a
/// warning when they are more than a thousandth of the map's sum.
/// Width must be twice the height within one texel. Throws Error (bad_input).
Image read_environment(const std::filesystem::path& path, std::size_t max_pixels = kMaxPixels);

/// Bilinear radiance from a direction; wraps in longitude, clamps at the poles.
Vec3 environment_radiance(const Image& environment, const Vec3& direction);

/// Draws directions in proportion to the map's luminance (averaged over a texel and its neighbours,
/// whose radiance the bilinear filter mixes) times solid angle. A black map is drawn uniformly.
class EnvironmentSampler {
 public:
  explicit EnvironmentSampler(const Image& environment);
  struct Sample {
    Vec3 direction;
    float pdf;  ///< per steradian
  };
  Sample sample(float u0, float u1) const;
  float pdf(const Vec3& direction) const;

 private:
  const double* columns(int y) const;
  float texel_pdf(int x, int y) const;

  int width_, height_;
  std::vector<double> row_cdf_;     // height + 1
  std::vector<double> column_cdf_;  // height × (width + 1)
};

}  // namespace prt::image
