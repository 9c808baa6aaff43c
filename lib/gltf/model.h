// The checked document as tinygltf understands it: what prtkit reads of a file, it reads here.
#pragma once

#include <tiny_gltf.h>

#include "core/vec.h"
#include "gltf/state.h"

namespace prt::gltf {

/// A snapshot of the JSON, taken anew by everyone who reads, so that it cannot fall behind it. It
/// has what prtkit reads; bytes stay in the state, which must outlive it.
struct Model : tinygltf::Model {
  const State& state;

  Where where(const char* kind, std::size_t index) const { return state.where(kind, index); }
  std::span<const std::byte> view_bytes(int buffer_view) const;
};

/// Of a document that check_document has passed or that we made. Throws Error (bad_input) with
/// what tinygltf has to say.
Model read_model(const State& state);

/// A primitive of triangles, where the default scene shows it. Order: depth first through the
/// nodes, as listed; primitives of a mesh in order. All numbering of vertices follows it.
struct PrimitiveUse {
  std::size_t node, mesh, primitive;
  Matrix4 world_from_local;  ///< of a mesh with a skin, whose joints alone move it, the identity
};
std::vector<PrimitiveUse> list_primitives(const Model& model);
const tinygltf::Primitive& primitive_of(const Model& model, const PrimitiveUse& use);
Json& primitive_of(State& state, const PrimitiveUse& use);
/// For messages: "mesh 3: primitive 0".
Where where_of(const Model& model, const PrimitiveUse& use);
/// The node's name, or else the mesh's, or else "mesh 3".
std::string name_of(const Model& model, const PrimitiveUse& use);

}  // namespace prt::gltf
