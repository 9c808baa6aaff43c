// The functions y(v) of exit radiance in the direction to the eye, which fragment shaders dot with
// interpolated coefficients [Sloan03] §6.2: as polynomials, or from a map.
#pragma once

#include <string>
#include <vector>

#include "runtime/exit_layout.h"

namespace prt::runtime {

enum class ViewBasis {
  polynomial,  ///< evaluated for each pixel: exact
  map          ///< fetched from a texture (runtime/hemisphere_map.h), as the paper does
};

/// Coefficients of 1, z, z², … of what Y(l,±m) is beside Re or Im (x + iy)^m, m >= 0; every other
/// one is 0. See sh/recurrence.h.
std::vector<double> polynomial_of_z(int l, int m);

/// The functions of a glossy layout for view_polynomials.glsl: "F(0, vec4(…)) F(1, vec4(…)) …" by
/// slot, 0 in slots that fill up, where z, zz are the direction's z and its square and p[m] is
/// (x + iy)^m.
std::string basis_polynomials(const ExitLayout& layout);

}  // namespace prt::runtime
