#include "mesh/mesh_file.h"

#include <string>

#include "core/error.h"

namespace prt::mesh {

namespace {

Scene one_primitive(TriangleMesh mesh, const std::filesystem::path& path) {
  Scene scene;
  scene.primitives.push_back({.name = path.stem().string(), .mesh = std::move(mesh)});
  return scene;
}

}  // namespace

bool is_mesh_file(const std::filesystem::path& path) {
  const std::string kind = lower_extension(path);
  return kind == ".obj" || kind == ".ply" || kind == ".off" || kind == ".stl";
}

Scene read_mesh_file(const std::filesystem::path& path, const ReadLimits& limits) {
  if (!is_mesh_file(path)) {
    throw_bad_input("unknown kind of mesh file", {.file = path.string(),
                                                  .found = "\"" + path.extension().string() + "\"",
                                                  .expected = ".obj, .ply, .off or .stl"});
  }
  const std::string text = read_text_file(path, limits.max_file_bytes);
  const std::string kind = lower_extension(path);
  Scene scene = kind == ".obj"   ? read_obj(text, path, limits)
                : kind == ".ply" ? one_primitive(read_ply(text, path), path)
                : kind == ".off" ? one_primitive(read_off(text, path), path)
                                 : one_primitive(read_stl(text, path), path);
  if (scene.triangle_count() == 0) {
    throw_bad_input("empty mesh: no triangle in the file", {.file = path.string()});
  }
  return scene;
}

}  // namespace prt::mesh
