// A triangle mesh as glTF stores one primitive: parallel vertex arrays and an index list.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace prt::mesh {

/// Attributes are either empty or as long as `positions`.
struct TriangleMesh {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;           ///< unit length
  std::vector<Vec4> tangents;          ///< xyz unit length, w = ±1 as in glTF
  std::vector<Vec2> texcoords;         ///< TEXCOORD_0, (0, 0) at the image's upper left
  std::vector<Vec4> colors;            ///< COLOR_0, linear
  std::vector<std::uint32_t> indices;  ///< three a triangle, counter-clockwise from the front

  std::size_t vertex_count() const { return positions.size(); }
  std::size_t triangle_count() const { return indices.size() / 3; }
  std::array<std::uint32_t, 3> triangle(std::size_t i) const {
    return {indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]};
  }
};

}  // namespace prt::mesh
