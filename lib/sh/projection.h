// Latitude-longitude maps (convention of image/environment.h) as functions that are constant on
// each texel, integrated exactly: the map's longitude is the azimuth about +Y, so a texel's
// integral of Y(l,m) is a product of one of cos or sin(m phi) over its columns and one of the
// Legendre part over its rows.
#pragma once

#include <array>

#include "core/vec.h"

namespace prt::sh {

/// Solid angle of each texel of a row; over all texels they sum to 4 pi.
double texel_solid_angle(int width, int height, int row);

/// Integral of the squared radiance over the sphere, per channel; its SH coefficients' squares sum
/// to this as the bands go to infinity.
std::array<double, 3> environment_energy(int width, int height, const float* rgb);

}  // namespace prt::sh
