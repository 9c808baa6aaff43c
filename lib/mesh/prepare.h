// From what a mesh file held to what baking wants: repair, refine, normals, tangents, for a whole
// scene at once.
#pragma once

#include "mesh/repair.h"
#include "mesh/scene.h"

namespace prt::mesh {

enum class UpAxis { y, z };

struct PrepareOptions {
  RepairOptions repair;
  float max_edge = 0.0f;                   ///< longest edge in metres after refinement; 0: as it is
  std::size_t max_triangles = 50'000'000;  ///< of one mesh after refinement
};

/// Repairs, refines and completes every primitive; empty ones go. reports[i] is of primitive i of
/// the result. Throws Error (bad_input) when nothing is left; `file` is for the message.
std::vector<RepairReport> prepare(Scene& scene, const PrepareOptions& options,
                                  const std::string& file);

/// One primitive. Returns where its vertices came from when max_edge is 0; empty otherwise.
std::vector<std::uint32_t> prepare(TriangleMesh& mesh, const PrepareOptions& options,
                                   RepairReport& report);

/// Moves a scene in file units and axes to metres with +Y up.
void to_world(Scene& scene, float metres_per_unit, UpAxis up);

}  // namespace prt::mesh
