// Reads mesh files as they are: .obj (with .mtl and its textures), .ply, .off, .stl, chosen by the
// name's ending and checked by content. Nothing is repaired here: normals may be missing, vertices
// may be unused or not finite, triangles degenerate (see mesh/repair.h). Polygons become fans.
//
// Every reader throws Error (bad_input) naming file and line or element when the file is missing,
// truncated, of another kind, empty, refers to vertices that it does not have, or announces more
// elements than its size can hold. Nothing is allocated from a count before that count is checked.
#pragma once

#include <filesystem>
#include <string_view>

#include "core/file.h"
#include "mesh/scene.h"

namespace prt::mesh {

struct ReadLimits {
  std::size_t max_file_bytes = kMaxInputBytes;
  std::size_t max_image_pixels = image::kMaxPixels;  ///< of all textures together
};

/// One primitive for each material used (.obj), or one.
Scene read_mesh_file(const std::filesystem::path& path, const ReadLimits& limits = {});

/// Whether read_mesh_file knows this ending.
bool is_mesh_file(const std::filesystem::path& path);

/// The same from memory; `path` is for messages and, in OBJ, for what the file refers to.
Scene read_obj(std::string_view text, const std::filesystem::path& path, const ReadLimits& limits);
TriangleMesh read_ply(std::string_view bytes, const std::filesystem::path& path);
TriangleMesh read_off(std::string_view text, const std::filesystem::path& path);
TriangleMesh read_stl(std::string_view bytes, const std::filesystem::path& path);

}  // namespace prt::mesh
