// What a Document holds: the JSON as it was read, and the bytes of its buffers. Working on the JSON
// itself is what lets everything that prtkit does not know survive; tinygltf's model, for one,
// wraps large integers and drops nulls, empty arrays and some extras and extensions.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"
#include "gltf/document.h"
#include "gltf/json.h"

namespace prt::gltf {

using Bytes = std::vector<std::byte>;

struct Document::State {
  Json root;
  std::vector<Bytes> buffers;  ///< one a glTF buffer, whole
  std::string file;            ///< for messages
  Limits limits;

  Where where(const char* kind, std::size_t index) const {
    return {file, std::string(kind) + " " + std::to_string(index)};
  }
  std::size_t count(const char* array) const { return array_of(root, array).size(); }
  const Json& element(const char* array, std::size_t i) const { return root.at(array).at(i); }
  std::span<const std::byte> view_bytes(std::size_t buffer_view) const;
};

using State = Document::State;

/// A primitive of triangles, where the default scene shows it. Order: depth first through the
/// nodes, as listed; primitives of a mesh in order. All numbering of vertices follows it.
struct PrimitiveUse {
  std::size_t node, mesh, primitive;
  Matrix4 world_from_local;
};
std::vector<PrimitiveUse> list_primitives(const State& state);
const Json& primitive_of(const State& state, const PrimitiveUse& use);
Json& primitive_of(State& state, const PrimitiveUse& use);

/// TRIANGLES, TRIANGLE_STRIP or TRIANGLE_FAN; the others draw points and lines.
constexpr std::size_t kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6;
std::size_t primitive_mode(const State& state, const Json& primitive);

/// Takes PRTKIT_precomputed_transfer out, everywhere.
void remove_precomputed_transfer(State& state);

}  // namespace prt::gltf
