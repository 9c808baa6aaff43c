// Functions symmetric about an axis: one coefficient z_l per band about +Z, the coefficient of
// Y(l,0); every other axis follows by the addition theorem.
#pragma once

#include <span>
#include <vector>

#include "core/vec.h"

namespace prt::sh {

/// max(0, cos theta) about +Z, the diffuse lobe [Ramamoorthi and Hanrahan 2001]: band_count values.
std::vector<double> cosine_lobe(int band_count);

/// 1 inside the angular radius (radians, 0 to pi) about +Z, 0 outside: band_count values.
std::vector<double> disk_lobe(int band_count, double radius);

/// The lobe about a unit axis instead: coefficient (l,m) = sqrt(4 pi / (2l+1)) z_l Y(l,m)(axis).
/// zonal.size()² values.
void turn_lobe(std::span<const double> zonal, const Vec3& axis, std::span<double> coefficients);
void turn_lobe(std::span<const double> zonal, const Vec3& axis, std::span<float> coefficients);

}  // namespace prt::sh
