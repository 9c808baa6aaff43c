#include "mesh/topology.h"

// OpenMesh's vectors are not initialised by design; GCC says so when sanitizers change its
// inlining.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include "mesh/weld.h"

namespace prt::mesh {

namespace {

// OpenMesh reports every face that it refuses on its error stream; we count them instead.
class QuietOpenMesh {
 public:
  QuietOpenMesh() { omerr().disable(); }
  ~QuietOpenMesh() { omerr().enable(); }
};

}  // namespace

Topology examine_topology(const TriangleMesh& mesh) {
  const QuietOpenMesh quiet;
  const std::vector<std::uint32_t> first = first_at_same_position(mesh);
  OpenMesh::TriMesh_ArrayKernelT<> surface;
  surface.reserve(mesh.vertex_count(), mesh.triangle_count() * 3 / 2, mesh.triangle_count());
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) surface.add_vertex({});
  const auto vertex = [&](std::uint32_t index) {
    return OpenMesh::VertexHandle(static_cast<int>(first[index]));
  };
  Topology topology;
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const auto [a, b, c] = mesh.triangle(i);
    if (first[a] == first[b] || first[b] == first[c] || first[c] == first[a]) continue;
    const auto face = surface.add_face(vertex(a), vertex(b), vertex(c));
    if (!face.is_valid()) ++topology.nonmanifold_triangle_count;
  }
  for (const auto edge : surface.edges()) topology.boundary_edge_count += surface.is_boundary(edge);
  for (const auto handle : surface.vertices()) {
    topology.nonmanifold_vertex_count += !surface.is_manifold(handle);
  }
  return topology;
}

}  // namespace prt::mesh
