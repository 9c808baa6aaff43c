// Whether a mesh is fine enough for transfer at its vertices. Between them exit radiance is
// interpolated, linearly over each triangle: of a floor of two triangles what stands in its middle
// casts no shadow. So points between the vertices are traced as if they were some, and compared
// with what their triangle's corners say:
//
//   e² = Σ ‖E(p) - Σ_k b_k E(v_k)‖² / Σ ‖E(p)‖²
//
// over points p of equal distance in area, b_k their barycentric coordinates and E the irradiance
// transfer E⁰ of transfer/diffuse.h in 5 bands, which hold all but 1% of its energy. Colours are
// left out: textures between the vertices are another matter.
#pragma once

#include <vector>

#include "transfer/diffuse.h"
#include "transfer/scene_index.h"

namespace prt::transfer {

/// e of each primitive, of 1 to 256 points each, some 4,096 in all, with 512 rays a point; 0 of one
/// without area, or whose points are all buried. The same for any number of threads.
std::vector<double> interpolation_errors(const SceneIndex& index);

/// Tells them in stats, whose primitives are those of the index.
void measure_interpolation(const SceneIndex& index, DiffuseStats& stats);

}  // namespace prt::transfer
