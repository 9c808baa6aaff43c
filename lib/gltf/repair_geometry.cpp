#include "gltf/repair_geometry.h"

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

std::vector<float> gather_components(const Model& model, int index,
                                     const std::vector<std::uint32_t>& source) {
  const std::vector<float> components = read_components(model, index);
  const std::size_t n = component_count(accessor_of(model, index));
  std::vector<float> gathered;
  gathered.reserve(source.size() * n);
  for (const std::uint32_t i : source) {
    gathered.insert(gathered.end(), &components[i * n], &components[i * n] + n);
  }
  return gathered;
}

// Rearranges an accessor's elements into a new one of the same type.
std::size_t gather_accessor(State& state, const Model& model, const std::string& name, int index,
                            const std::vector<std::uint32_t>& source) {
  const tinygltf::Accessor& from = accessor_of(model, index);
  const std::size_t size = element_bytes(from.componentType, from.type);
  const std::size_t stride = (size + 3) / 4 * 4;
  const Bytes elements = read_elements(model, index);
  Bytes gathered(source.size() * stride);
  for (std::size_t i = 0; i < source.size(); ++i) {
    std::memcpy(&gathered[i * stride], &elements[source[i] * size], size);
  }
  Json accessor = state.element("accessors", static_cast<std::size_t>(index));
  const std::string type = accessor["type"].get<std::string>();
  const std::size_t added = add_accessor(state,
                                         {.component_type = from.componentType,
                                          .type = type.c_str(),
                                          .count = source.size(),
                                          .stride = stride,
                                          .target = TINYGLTF_TARGET_ARRAY_BUFFER},
                                         std::move(gathered));
  accessor.erase("sparse");
  accessor.erase("byteOffset");
  for (const auto& [key, value] : state.element("accessors", added).items()) accessor[key] = value;
  const bool bounded = name == "POSITION" || accessor.contains("min") || accessor.contains("max");
  state.root["accessors"][added] = std::move(accessor);
  if (bounded) set_bounds(state, added, gather_components(model, index, source));
  return added;
}

// Attributes that a TriangleMesh does not carry, moved along or, without `source`, dropped.
void carry_other_attributes(State& state, const Model& model, Json& attributes,
                            const std::vector<std::uint32_t>& source, const Where& where) {
  Json carried = Json::object();
  for (const auto& [name, accessor] : attributes.items()) {
    if (is_interpolated(name)) {
      carried[name] = accessor;
    } else if (!source.empty()) {
      carried[name] = gather_accessor(state, model, name, accessor.get<int>(), source);
    } else {
      log::warning("{}: {}: {} cannot be interpolated, dropped", where.file, where.element, name);
    }
  }
  attributes = std::move(carried);
}

void carry_targets(State& state, const Model& model, Json& primitive,
                   const std::vector<std::uint32_t>& source, const Where& where) {
  if (!primitive.contains("targets")) return;
  if (source.empty()) {
    log::warning("{}: {}: morph targets cannot be refined, dropped", where.file, where.element);
    primitive.erase("targets");
    return;
  }
  for (Json& target : primitive["targets"]) {
    for (auto& [name, accessor] : target.items()) {
      accessor = gather_accessor(state, model, name, accessor.get<int>(), source);
    }
  }
}

class PrimitiveRepair {
 public:
  PrimitiveRepair(State& state, const Model& model, const PrimitiveUse& use,
                  const ImportOptions& options)
      : state_(state),
        model_(model),
        use_(use),
        options_(options.prepare),
        where_(where_of(model, use)) {}

  ImportedMesh run() {
    const tinygltf::Primitive& before = primitive_of(model_, use_);
    mesh::TriangleMesh mesh = read_geometry(model_, before, where_);
    // Vertices are merged only where no indices, or indices made for other normals, say which ones
    // are the same.
    options_.repair.weld =
        (before.indices < 0 || options_.repair.recompute_normals) && !has_other_data(before);
    const bool had_tangents = !mesh.tangents.empty();
    const std::size_t triangle_count = mesh.triangle_count(), vertices = mesh.vertex_count();
    const std::vector<Vec3> normals = mesh.normals;
    ImportedMesh imported;
    std::vector<std::uint32_t> source = mesh::repair(mesh, options_.repair, imported.repair);
    if (mesh.triangle_count() == 0) return imported;
    check_transform(use_.world_from_local, mesh, where_);
    const bool same = mesh.triangle_count() == triangle_count && mesh.vertex_count() == vertices &&
                      mesh.normals == normals && had_tangents == !mesh.tangents.empty() &&
                      imported.repair.mended_attribute_count == 0;
    if (options_.max_edge > 0.0f) {
      const std::size_t repaired = mesh.vertex_count();
      mesh::tessellate(mesh, options_.max_edge, options_.max_triangles, use_.world_from_local);
      if (mesh.vertex_count() != repaired) source.clear();
    }
    imported.vertex_count = mesh.vertex_count();
    imported.triangle_count = mesh.triangle_count();
    if (same && !source.empty() && is_ready(before)) return imported;
    Json& primitive = primitive_of(state_, use_);
    if (had_tangents && mesh.tangents.empty()) {
      primitive["attributes"].erase("TANGENT");
      if (!mesh.texcoords.empty()) mesh::compute_tangents(mesh);
    }
    primitive["mode"] = TINYGLTF_MODE_TRIANGLES;
    carry_other_attributes(state_, model_, primitive["attributes"], source, where_);
    carry_targets(state_, model_, primitive, source, where_);
    write_geometry(state_, primitive, mesh);
    changed_ = true;
    return imported;
  }

  bool changed() const { return changed_; }

 private:
  static bool has_other_data(const tinygltf::Primitive& primitive) {
    return !primitive.targets.empty() ||
           std::any_of(primitive.attributes.begin(), primitive.attributes.end(),
                       [](const auto& attribute) { return !is_interpolated(attribute.first); });
  }

  static bool is_ready(const tinygltf::Primitive& primitive) {
    return primitive.indices >= 0 && primitive.mode == TINYGLTF_MODE_TRIANGLES;
  }

  State& state_;
  const Model& model_;
  PrimitiveUse use_;
  mesh::PrepareOptions options_;
  Where where_;
  bool changed_ = false;
};

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
  const Model model = read_model(state);
  const std::vector<PrimitiveUse> uses = list_primitives(model);
  if (options.base_color) color_bare_primitives(state, uses, *options.base_color);
  std::vector<ImportedMesh> meshes;
  std::set<std::pair<std::size_t, std::size_t>> dead;
  bool changed = false;
  for (const PrimitiveUse& use : uses) {
    PrimitiveRepair repair(state, model, use, options);
    ImportedMesh imported = repair.run();
    changed |= repair.changed();
    imported.name = name_of(model, use);
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
