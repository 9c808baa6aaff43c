// prt-import's work on a glTF file: everything else in the file stays as it is.
#pragma once

#include <vector>

#include "gltf/import.h"
#include "gltf/state.h"

namespace prt::gltf {

/// Gives every node a mesh of its own; turns strips, fans and lists without indices into indexed
/// triangles; repairs, refines and completes what Document::scene would reject or what the options
/// ask for, and leaves alone what is good. All attributes and morph targets follow the vertices,
/// except that refining drops those it cannot interpolate (with a warning). Primitives of which
/// nothing is left go. Throws Error (bad_input) when no triangle is left at all.
std::vector<ImportedMesh> repair_geometry(State& state, const ImportOptions& options);

}  // namespace prt::gltf
