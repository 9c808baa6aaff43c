// The local shading frame of a vertex: z along the normal, x along the tangent, y along the
// bitangent as glTF defines it, on either side. Directional transfer is stored in it.
#pragma once

#include "mesh/triangle_mesh.h"

namespace prt::mesh {

struct Frame {
  Vec3 x, y, z;  ///< orthonormal; left-handed where the tangent's w is -1
};

/// TANGENT made orthogonal to NORMAL. Without one, or along the normal, x is the world's X axis
/// made orthogonal to the normal (Z where the normal is within 0.1 of ±X), right-handed.
Frame frame_at_vertex(const TriangleMesh& mesh, std::size_t vertex);

}  // namespace prt::mesh
