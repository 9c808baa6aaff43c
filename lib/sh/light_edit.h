// What prt-light does to a light after it is made, and the figures that it reports.
#pragma once

#include <vector>

#include "sh/light.h"

namespace prt::sh {

struct LightEdit {
  Vec3 rotation{0};    ///< degrees about world +X, then +Y, then +Z, right-handed
  float exposure = 0;  ///< stops: radiance times 2^exposure
};

Light edited(const Light& light, const LightEdit& edit);

/// a + b; the light of fewer bands is padded. Sources are joined by " + ".
Light sum(const Light& a, const Light& b);

struct LightStatistics {
  std::vector<double> band_energy;  ///< per band, squares summed over its coefficients and channels
  double energy = 0;                ///< their sum, the integral of r² + g² + b² over the sphere
  double minimum_luminance = 0;     ///< over a fine grid; negative where the light rings
  double maximum_luminance = 0;
  double negative_fraction = 0;  ///< share of the sphere's solid angle with negative luminance
};

LightStatistics statistics_of(const Light& light);

}  // namespace prt::sh
