// Lights that a model has inside of it, where they leave it dark.
#pragma once

#include <span>

#include "runtime/light_field.h"
#include "runtime/model.h"

namespace prt::runtime {

/// How often the triangles go around a point, seen from their back positively: 1 inside of a closed
/// model, 0 outside, -1 in a closed room whose triangles face inward; in between where there are
/// holes. The sum of their solid angles [Van Oosterom and Strackee 1983] over 4π.
double winding_number(const Model& model, const Vec3& point);

/// Warns of each light that is behind the front of most triangles around it, and too small to reach
/// through them to any vertex: the model is black, as it is by physics where it is closed.
void warn_of_lights_inside(const Model& model, std::span<const NearLight> lights);

}  // namespace prt::runtime
