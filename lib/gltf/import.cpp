#include "gltf/import.h"

#include "core/error.h"
#include "core/file.h"
#include "gltf/repair_geometry.h"
#include "mesh/mesh_file.h"

namespace prt::gltf {

namespace {

void color_bare_primitives(mesh::Scene& scene, const Vec3& color) {
  int material = -1;
  for (mesh::Primitive& primitive : scene.primitives) {
    if (primitive.material >= 0) continue;
    if (material < 0) {
      material = static_cast<int>(scene.materials.size());
      scene.materials.emplace_back().base_color = Vec4(color.x, color.y, color.z, 1.0f);
    }
    primitive.material = material;
  }
}

ImportResult import_mesh_file(const std::filesystem::path& path, const ImportOptions& options) {
  mesh::Scene scene =
      mesh::read_mesh_file(path, {.max_file_bytes = options.limits.max_file_bytes,
                                  .max_image_pixels = options.limits.max_image_pixels});
  mesh::to_world(scene, options.metres_per_unit, options.up);
  const auto repairs = mesh::prepare(scene, options.prepare, path.string());
  color_bare_primitives(scene, options.base_color.value_or(Vec3(1.0f)));
  ImportResult result{Document::from_scene(scene), {}};
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
    const mesh::Primitive& primitive = scene.primitives[i];
    result.meshes.push_back({.name = primitive.name,
                             .vertex_count = primitive.mesh.vertex_count(),
                             .triangle_count = primitive.mesh.triangle_count(),
                             .repair = repairs[i]});
  }
  return result;
}

ImportResult import_gltf(const std::filesystem::path& path, const ImportOptions& options) {
  if (options.metres_per_unit != 1.0f || options.up != mesh::UpAxis::y) {
    throw Error(ErrorKind::usage, "glTF is in metres with +Y up: --unit and --up are for others",
                {.file = path.string()});
  }
  ImportResult result{Document::load(path, options.limits), {}};
  result.meshes = repair_geometry(*result.document.state(), options);
  return result;
}

}  // namespace

ImportResult import_file(const std::filesystem::path& path, const ImportOptions& options) {
  if (mesh::is_mesh_file(path)) return import_mesh_file(path, options);
  const std::string ending = lower_extension(path);
  if (ending == ".gltf" || ending == ".glb") return import_gltf(path, options);
  check_input(path);
  throw_bad_input("unknown kind of file", {.file = path.string(),
                                           .found = "\"" + ending + "\"",
                                           .expected = ".obj, .ply, .off, .stl, .gltf or .glb"});
}

}  // namespace prt::gltf
