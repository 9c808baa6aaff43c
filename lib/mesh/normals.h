// Vertex normals and tangents computed from triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace prt::mesh {

/// Computes unit normals, each face weighted by its angle at the vertex [Thürmer, Wüthrich 1998].
/// Faces around a position whose normals differ by more than `crease_angle_degrees` are not mixed:
/// the vertex is then split (180: never). Vertices at the same position count as one. Returns, for
/// each vertex of the result, the vertex that it was before.
std::vector<std::uint32_t> compute_normals(TriangleMesh& mesh, float crease_angle_degrees);

/// Computes a unit tangent of each vertex along growing texcoords.x, orthogonal to the normal, w
/// the side of the bitangent, w = ±1. A vertex where two sides meet keeps the side of most area.
/// Precondition: normals and texcoords present.
void compute_tangents(TriangleMesh& mesh);

}  // namespace prt::mesh
