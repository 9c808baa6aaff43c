// Reflection of the materials of a scene.
#pragma once

#include "brdf/brdf.h"
#include "mesh/scene.h"

namespace prt::brdf {

/// All of a material but its base colour, which is that of the point (mesh::albedo_at_point) and
/// white here.
MetallicRoughness metallic_roughness(const mesh::Material& material);

}  // namespace prt::brdf
