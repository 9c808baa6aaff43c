// What the lobes share: half vectors, mirroring, Schlick's term, cosine sampling.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "brdf/lobe.h"

namespace prt::brdf {

constexpr double kPi = std::numbers::pi;

inline bool above(const Direction& light, const Direction& eye) { return light.z > 0 && eye.z > 0; }

/// Between two directions, on the upper side.
inline Direction half_vector(const Direction& light, const Direction& eye) {
  const Direction h = (light + eye).normalized();
  return h.z < 0 ? -h : h;
}

inline Direction mirror(const Direction& w, const Direction& h) { return h * (2 * (w ^ h)) - w; }

inline double schlick(Fresnel fresnel, double cosine) {
  if (fresnel == Fresnel::one) return 1;
  const double x = std::clamp(1 - cosine, 0.0, 1.0);
  const double s = x * x * x * x * x;
  return fresnel == Fresnel::facing ? 1 - s : s;
}

inline const char* name_of(Fresnel fresnel) {
  return fresnel == Fresnel::one ? "one" : fresnel == Fresnel::facing ? "facing" : "grazing";
}

/// Density cos θ / π over the upper hemisphere.
inline Direction sample_cosine(double u1, double u2) {
  const double r = std::sqrt(u1), phi = 2 * kPi * u2;
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u1)};
}

}  // namespace prt::brdf
