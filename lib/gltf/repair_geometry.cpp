#include "gltf/repair_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <set>

#include "core/error.h"
#include "core/log.h"
#include "gltf/accessor.h"
#include "gltf/geometry.h"
#include "mesh/normals.h"
#include "mesh/tessellate.h"

namespace prt::gltf {

namespace {

constexpr const char* kInterpolated[] = {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0", "COLOR_0"};

bool is_interpolated(const std::string& name) {
  return std::find(std::begin(kInterpolated), std::end(kInterpolated), name) !=
         std::end(kInterpolated);
}

// A second node of a mesh gets a copy of it; accessors stay shared until they change.
void give_every_node_a_mesh(State& state) {
  std::set<std::size_t> used;
  for (std::size_t i = 0; i < state.count("nodes"); ++i) {
    Json& node = state.root["nodes"][i];
    const auto mesh = optional_index(node, "mesh", state.count("meshes"), state.where("node", i));
    if (!mesh || used.insert(*mesh).second) continue;
    Json copy = state.root["meshes"][*mesh];
    node["mesh"] = state.count("meshes");
    state.root["meshes"].push_back(std::move(copy));
  }
}

// Rearranges an accessor's elements into a new one of the same type.
std::size_t gather_accessor(State& state, std::size_t index,
                            const std::vector<std::uint32_t>& source) {
  Json accessor = state.element("accessors", index);
  const std::size_t size = element_bytes(accessor), stride = (size + 3) / 4 * 4;
  const Bytes elements = read_elements(state, index);
  Bytes gathered(source.size() * stride);
  for (std::size_t i = 0; i < source.size(); ++i) {
    std::memcpy(&gathered[i * stride], &elements[source[i] * size], size);
  }
  const std::string type = accessor["type"].get<std::string>();
  const std::size_t added = add_accessor(state,
                                         {.component_type = accessor["componentType"],
                                          .type = type.c_str(),
                                          .count = source.size(),
                                          .stride = stride,
                                          .target = kVertices},
                                         std::move(gathered));
  accessor.erase("sparse");
  accessor.erase("byteOffset");
  for (const auto& [key, value] : state.element("accessors", added).items()) accessor[key] = value;
  state.root["accessors"][added] = std::move(accessor);
  return added;
}

// Attributes that a TriangleMesh does not carry, moved along or, without `source`, dropped.
void carry_other_attributes(State& state, Json& attributes,
                            const std::vector<std::uint32_t>& source, const Where& where) {
  Json carried = Json::object();
  for (const auto& [name, accessor] : attributes.items()) {
    if (is_interpolated(name)) {
      carried[name] = accessor;
    } else if (!source.empty()) {
      carried[name] = gather_accessor(state, accessor.get<std::size_t>(), source);
    } else {
      log::warning("{}: {}: {} cannot be interpolated, dropped", where.file, where.element, name);
    }
  }
  attributes = std::move(carried);
}

void carry_targets(State& state, Json& primitive, const std::vector<std::uint32_t>& source,
                   const Where& where) {
  if (!primitive.contains("targets")) return;
  if (source.empty()) {
    log::warning("{}: {}: morph targets cannot be refined, dropped", where.file, where.element);
    primitive.erase("targets");
    return;
  }
  for (Json& target : primitive["targets"]) {
    for (auto& [name, accessor] : target.items()) {
      const std::size_t moved = gather_accessor(state, accessor.get<std::size_t>(), source);
      if (name == "POSITION") set_bounds(state, moved);
      accessor = moved;
    }
  }
}

class PrimitiveRepair {
 public:
  PrimitiveRepair(State& state, const PrimitiveUse& use, const ImportOptions& options)
      : state_(state),
        use_(use),
        options_(options.prepare),
        where_{state.file, fmt::format("mesh {}: primitive {}", use.mesh, use.primitive)} {}

  ImportedMesh run() {
    Json& primitive = primitive_of(state_, use_);
    mesh::TriangleMesh mesh = read_geometry(state_, primitive, where_);
    // Vertices are merged only where there are no indices that say which ones are the same.
    options_.repair.weld = !primitive.contains("indices") && !has_other_data(primitive);
    const bool had_tangents = !mesh.tangents.empty();
    const std::size_t triangle_count = mesh.triangle_count(), vertices = mesh.vertex_count();
    const std::vector<Vec3> normals = mesh.normals;
    ImportedMesh imported;
    std::vector<std::uint32_t> source = mesh::repair(mesh, options_.repair, imported.repair);
    if (mesh.triangle_count() == 0) return imported;
    const bool same = mesh.triangle_count() == triangle_count && mesh.vertex_count() == vertices &&
                      mesh.normals == normals;
    if (options_.max_edge > 0.0f) {
      const std::size_t before = mesh.vertex_count();
      mesh::tessellate(mesh, options_.max_edge, options_.max_triangles, use_.world_from_local);
      if (mesh.vertex_count() != before) source.clear();
    }
    imported.vertex_count = mesh.vertex_count();
    imported.triangle_count = mesh.triangle_count();
    if (same && !source.empty() && is_ready(primitive)) return imported;
    if (!had_tangents) mesh.tangents.clear();
    primitive["mode"] = kTriangles;
    carry_other_attributes(state_, primitive["attributes"], source, where_);
    carry_targets(state_, primitive, source, where_);
    write_geometry(state_, primitive, mesh);
    changed_ = true;
    return imported;
  }

  bool changed() const { return changed_; }

 private:
  static bool has_other_data(const Json& primitive) {
    if (primitive.contains("targets")) return true;
    for (const auto& [name, accessor] : primitive.at("attributes").items()) {
      if (!is_interpolated(name)) return true;
    }
    return false;
  }

  bool is_ready(const Json& primitive) const {
    return primitive.contains("indices") && primitive_mode(state_, primitive) == kTriangles;
  }

  State& state_;
  PrimitiveUse use_;
  mesh::PrepareOptions options_;
  Where where_;
  bool changed_ = false;
};

std::string name_of(const State& state, const PrimitiveUse& use) {
  for (const auto& [array, index] : {std::pair("nodes", use.node), std::pair("meshes", use.mesh)}) {
    std::string name = optional_string(state.element(array, index), "name", {state.file, array});
    if (!name.empty()) return name;
  }
  return fmt::format("mesh {}", use.mesh);
}

// glTF wants at least one primitive in a mesh: a node whose mesh has none left loses it.
void drop_primitives(State& state, const std::set<std::pair<std::size_t, std::size_t>>& dead) {
  for (auto i = dead.rbegin(); i != dead.rend(); ++i) {
    Json& primitives = state.root["meshes"][i->first]["primitives"];
    if (primitives.size() > 1) {
      primitives.erase(i->second);
      continue;
    }
    for (Json& node : state.root["nodes"]) {
      const Json* mesh = find(node, "mesh");
      if (mesh && mesh->get<std::size_t>() == i->first) node.erase("mesh");
    }
  }
}

void color_bare_primitives(State& state, const std::vector<PrimitiveUse>& uses, const Vec3& color) {
  std::optional<std::size_t> material;
  for (const PrimitiveUse& use : uses) {
    if (primitive_of(state, use).contains("material")) continue;
    if (!material) {
      Json& materials = make_array(state.root, "materials");
      material = materials.size();
      materials.push_back(
          {{"pbrMetallicRoughness",
            {{"baseColorFactor", {color.x, color.y, color.z, 1.0f}}, {"metallicFactor", 0}}}});
    }
    primitive_of(state, use)["material"] = *material;
  }
}

}  // namespace

std::vector<ImportedMesh> repair_geometry(State& state, const ImportOptions& options) {
  give_every_node_a_mesh(state);
  const std::vector<PrimitiveUse> uses = list_primitives(state);
  if (options.base_color) color_bare_primitives(state, uses, *options.base_color);
  std::vector<ImportedMesh> meshes;
  std::set<std::pair<std::size_t, std::size_t>> dead;
  bool changed = false;
  for (const PrimitiveUse& use : uses) {
    PrimitiveRepair repair(state, use, options);
    ImportedMesh imported = repair.run();
    changed |= repair.changed();
    imported.name = name_of(state, use);
    if (imported.triangle_count > 0) {
      meshes.push_back(std::move(imported));
      continue;
    }
    log::warning("{}: {}: nothing left after repair, dropped", state.file, imported.name);
    dead.emplace(use.mesh, use.primitive);
  }
  if (meshes.empty()) {
    throw_bad_input("empty mesh: no triangle in the default scene is left after repair",
                    {.file = state.file});
  }
  drop_primitives(state, dead);
  if (changed || !dead.empty()) remove_precomputed_transfer(state);
  return meshes;
}

}  // namespace prt::gltf
