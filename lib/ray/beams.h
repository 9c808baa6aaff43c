// Directions of one list in beams of neighbours, made once for many origins.
#pragma once

#include <span>
#include <vector>

#include "ray/engine.h"
#include "ray/shadow_query.h"

namespace prt::ray {

/// Directions as three lists of their coordinates.
struct PlanarDirections {
  std::span<const float> x, y, z;
};

/// The face of a cube about the origin that a direction points at: 2 m + (d_m < 0) for its largest
/// coordinate m, and where on that face.
struct CubePlace {
  int face;
  float u, v;  ///< d_p / |d_m|, d_q / |d_m|; p, q follow m cyclically
};
CubePlace cube_place(const Vec3& direction);

/// Every direction of the list in one beam, in order. Directions are finite and not zero. Fast to
/// trace when runs of 16 are compact and on one face of the cube.
std::vector<Beam> make_beams(const PlanarDirections& directions);

}  // namespace prt::ray
