// Analytic lights from the numbers of a command line.
#pragma once

#include <span>

#include "sh/light.h"

namespace prt::sh {

enum class AnalyticKind {
  constant,    ///< R,G,B: radiance from everywhere
  disk,        ///< X,Y,Z,RADIUS,R,G,B: direction to it, angular radius in degrees, radiance
  directional  ///< X,Y,Z,R,G,B: direction to it, irradiance on a facing surface
};

/// How many numbers the kind takes.
int number_count(AnalyticKind kind);

/// The light, its source named by kind and numbers. Directions need not be unit. Throws Error
/// (usage) for a wrong count, numbers that are not finite, a direction without length, a radius
/// outside (0, 180].
Light analytic_light(AnalyticKind kind, int band_count, std::span<const float> numbers);

}  // namespace prt::sh
