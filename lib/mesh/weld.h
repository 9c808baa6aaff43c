// Equal vertices found by hashing.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace prt::mesh {

/// For each vertex the first vertex with the same position (−0 equals 0).
std::vector<std::uint32_t> first_at_same_position(const TriangleMesh& mesh);
/// For each vertex the first vertex equal in every attribute.
std::vector<std::uint32_t> first_with_same_attributes(const TriangleMesh& mesh);

}  // namespace prt::mesh
