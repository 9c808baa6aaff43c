// The lobes that every property is tested for, and directions to test it in.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "brdf/brdf.h"
#include "core/random.h"

namespace prt::brdf {

inline std::vector<LobePointer> all_lobes() {
  return {lambert(),
          lambert(Fresnel::facing),
          lambert(Fresnel::grazing),
          ashikhmin_shirley_diffuse(),
          phong(1),
          phong(10),
          phong(200),
          ggx(1, 1),
          ggx(0.25, 0.25),
          ggx(0.05, 0.05, Fresnel::facing),
          ggx(0.5, 0.1),
          ggx(0.25, 0.25, Fresnel::grazing, Masking::height_correlated),
          ggx(0.1, 0.6, Fresnel::one, Masking::height_correlated),
          ward(0.3, 0.3),
          ward(0.1, 0.4),
          ashikhmin_shirley(20, 20),
          ashikhmin_shirley(10, 100),
          ashikhmin_shirley(100, 10, Fresnel::grazing)};
}

inline Direction from_angles(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Uniform over the upper hemisphere.
inline Direction random_upper(Pcg32& random) {
  const double z = random.uniform(), phi = 2 * std::numbers::pi * random.uniform();
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

}  // namespace prt::brdf
