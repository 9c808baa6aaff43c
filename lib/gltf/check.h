// Everything that the rest of lib/gltf relies on, checked once after loading: types of the fields
// that are read, references within their arrays, views within their buffers, accessors within their
// views, the nodes a forest without cycles and not too deep.
#pragma once

#include "gltf/state.h"

namespace prt::gltf {

/// Throws Error (bad_input) naming the element. Only a document that passes is shown to tinygltf.
void check_document(const State& state);

/// The node graph alone: transforms, children in range, one parent at most, no cycle, depth.
void check_nodes(const State& state);

/// How much the scene describes: nodes may share meshes and primitives accessors, so that a small
/// file can ask for a huge one. Last, as it lists the primitives.
void check_size(const State& state);

}  // namespace prt::gltf
