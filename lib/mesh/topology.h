// What the edges of a mesh say about it; OpenMesh behind it.
#pragma once

#include <cstddef>

#include "mesh/triangle_mesh.h"

namespace prt::mesh {

struct Topology {
  std::size_t nonmanifold_triangle_count = 0;  ///< do not fit a surface of two faces an edge
  std::size_t nonmanifold_vertex_count = 0;    ///< several fans of faces meet in the vertex
  std::size_t boundary_edge_count = 0;         ///< edges of one face
};

/// Vertices at equal positions count as one, so seams of texture coordinates do not show.
Topology examine_topology(const TriangleMesh& mesh);

}  // namespace prt::mesh
