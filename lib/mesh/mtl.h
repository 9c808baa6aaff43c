// Material libraries of OBJ files: Kd becomes the base colour, map_Kd its texture.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "mesh/mesh_file.h"

namespace prt::mesh {

/// Reads the library that `obj` names and appends its materials to the scene; their numbers go into
/// `materials`, the first of a name wins. A library or texture that is missing or unreadable is a
/// warning, one outside the OBJ's folder an Error (bad_input).
void read_material_library(const std::filesystem::path& obj, std::string_view name,
                           const ReadLimits& limits, Scene& scene,
                           std::map<std::string, int>& materials);

}  // namespace prt::mesh
