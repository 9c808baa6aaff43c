// The functions of exit radiance as a texture: a map of the hemisphere that replaces evaluating
// them in the fragment shader [Sloan03] §6.2, on the parabolic parameterisation of [Heidrich and
// Seidel 1999].
//
// Direction (x,y,z), z >= 0, lies at p = (x,y) / (1 + z), the rim at |p| = 1. Texel t, counted from
// 0 in both coordinates, stands at p = 2 (t - 1) / (kHemisphereMapSize - 3) - 1, so that one texel
// surrounds the disk. Values are control points of the bicubic B-spline that interpolates the
// functions, which a shader evaluates by four bilinear fetches (hemisphere_map.glsl). Within
// five bands it errs by less than 0.1% of a function's range, where bilinear interpolation of the
// functions errs by 4% (tests/runtime/glossy_cpu_test.cpp).
#pragma once

#include <vector>

#include "core/vec.h"
#include "runtime/exit_layout.h"

namespace prt::runtime {

constexpr int kHemisphereMapSize = 32;

/// layout.color_vector_count() layers of kHemisphereMapSize² texels, functions by slot; 0 in slots
/// that fill up. The layout is glossy.
std::vector<Vec4> hemisphere_map(const ExitLayout& layout);

}  // namespace prt::runtime
