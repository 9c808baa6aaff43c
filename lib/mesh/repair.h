// Makes a triangle mesh that baking can trust out of whatever a file held: indices in range, finite
// vertices, no degenerate or double triangles, every vertex used, unit normals, finite texture
// coordinates, colours in [0, 1].
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace prt::mesh {

struct RepairOptions {
  bool weld = true;  ///< merge vertices whose attributes are all equal, bit for bit
  /// Where normals have to be computed: an edge whose faces' normals differ by more stays hard.
  /// 180: everything smooth. Unset: kCreaseAngle, and everything smooth where that would split
  /// fewer than one vertex in kVerticesPerCrease, since so few are noise of a scan.
  std::optional<float> crease_angle_degrees;
  bool recompute_normals = false;  ///< the file's normals and tangents are dropped first
};

constexpr float kCreaseAngle = 60.0f;
constexpr std::size_t kVerticesPerCrease = 50;

/// What was found and done; counts add up over the meshes of a file.
struct RepairReport {
  std::size_t welded_vertex_count = 0;
  std::size_t nonfinite_vertex_count = 0;      ///< dropped, with their triangles
  std::size_t unreferenced_vertex_count = 0;   ///< dropped
  std::size_t degenerate_triangle_count = 0;   ///< dropped: no area
  std::size_t duplicate_triangle_count = 0;    ///< dropped: the same three vertices, same side
  std::size_t nonfinite_triangle_count = 0;    ///< dropped with a vertex
  std::size_t computed_normal_count = 0;       ///< vertices whose normal was computed
  std::size_t split_vertex_count = 0;          ///< added, so that edges stay hard
  std::size_t mended_attribute_count = 0;      ///< vertices: not finite, or colour out of [0, 1]
  std::size_t nonmanifold_triangle_count = 0;  ///< kept: more than two faces at an edge
  std::size_t nonmanifold_vertex_count = 0;    ///< kept: bow ties
  std::size_t boundary_edge_count = 0;         ///< edges of one face

  void add(const RepairReport& other);
};

/// Repairs in place. source[i] is the vertex of the input that vertex i of the result came from.
/// Precondition: indices < vertex count, attributes empty or of vertex count length. The result may
/// be empty: what that means is the caller's to say.
std::vector<std::uint32_t> repair(TriangleMesh& mesh, const RepairOptions& options,
                                  RepairReport& report);

/// Vertices of `mesh` rearranged to those of `source`; indices are left alone.
void gather_vertices(TriangleMesh& mesh, const std::vector<std::uint32_t>& source);

}  // namespace prt::mesh
