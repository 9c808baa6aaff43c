// Spherical harmonic coefficients of the clamped cosine lobe about a normal: the irradiance that
// each basis function of light gives a surface which nothing shadows.
#pragma once

#include <span>

#include "core/vec.h"

namespace prt::transfer {

/// ∫ max(0, n·d) Y_lm(d) dd = A_l Y_lm(n) into band_count² floats; A_l of [Ramamoorthi, Hanrahan
/// 2001, An Efficient Representation for Irradiance Environment Maps] eq. 8.
void clamped_cosine(int band_count, const Vec3& normal, std::span<float> coefficients);

}  // namespace prt::transfer
