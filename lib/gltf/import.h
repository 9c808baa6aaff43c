// What prt-import does: any model file becomes a document that baking can trust.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gltf/document.h"
#include "mesh/prepare.h"

namespace prt::gltf {

struct ImportOptions {
  mesh::PrepareOptions prepare;
  /// Linear; of what has no material. None: white, but glTF keeps its own default.
  std::optional<Vec3> base_color;
  float metres_per_unit = 1.0f;  ///< mesh files only: glTF has its unit and axes
  mesh::UpAxis up = mesh::UpAxis::y;
  Limits limits;
};

struct ImportedMesh {
  std::string name;
  std::size_t vertex_count = 0, triangle_count = 0;
  mesh::RepairReport repair;
};

struct ImportResult {
  Document document;
  std::vector<ImportedMesh> meshes;  ///< in the order of Document::scene().primitives
};

/// Reads .obj .ply .off .stl .gltf .glb. Throws Error (bad_input).
ImportResult import_file(const std::filesystem::path& path, const ImportOptions& options);

}  // namespace prt::gltf
