// Conforming refinement: patches small enough for per-vertex lighting.
#pragma once

#include <cstddef>

#include "core/vec.h"
#include "mesh/triangle_mesh.h"

namespace prt::mesh {

/// Splits every edge longer than `max_edge` at its midpoint, and each triangle by how many of its
/// edges were split (one: 2 triangles, two: 3, three: 4), until no edge is longer. Whether an edge
/// is split depends on its end points alone, so triangles that share it, even by different vertices
/// at equal positions, agree: no T-junctions. Attributes are interpolated, normals and tangents
/// made unit again. Lengths are measured after `world_from_local`. Throws Error (failed) when there
/// would be more than `max_triangles`, before the work where their area or edges tell.
/// Precondition: finite positions, indices in range, max_edge > 0.
void tessellate(TriangleMesh& mesh, float max_edge, std::size_t max_triangles,
                const Matrix4& world_from_local = {});

}  // namespace prt::mesh
