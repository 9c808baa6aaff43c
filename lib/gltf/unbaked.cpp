// Document::unbaked_features.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "gltf/document.h"
#include "gltf/model.h"

namespace prt::gltf {

namespace {

/// "a, b, c and 2 more".
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 3;
  const std::size_t shown = std::min(names.size(), kMost);
  std::string text = fmt::format("{}", fmt::join(names.begin(), names.begin() + shown, ", "));
  if (names.size() > kMost) text += fmt::format(" and {} more", names.size() - kMost);
  return text;
}

void add_motion(const Model& model, std::vector<std::string>& features) {
  std::vector<std::string> skinned, morphed;
  std::set<std::size_t> seen;
  for (const PrimitiveUse& use : list_primitives(model)) {
    if (!seen.insert(use.node).second) continue;
    const tinygltf::Node& node = model.nodes[use.node];
    const auto& primitives = model.meshes[use.mesh].primitives;
    if (node.skin >= 0) skinned.push_back(name_of(model, use));
    if (std::any_of(primitives.begin(), primitives.end(),
                    [](const tinygltf::Primitive& p) { return !p.targets.empty(); }))
      morphed.push_back(name_of(model, use));
  }
  if (!skinned.empty()) features.push_back("skins are baked in bind pose: " + listed(skinned));
  if (!morphed.empty())
    features.push_back("morph targets are left out, whatever their weights: " + listed(morphed));
  const std::size_t animation_count = model.state.count("animations");
  if (animation_count > 0) {
    features.push_back(fmt::format("{} animation{} left out: nodes are baked as they stand",
                                   animation_count, animation_count > 1 ? "s are" : " is"));
  }
}

/// Extensions of materials and the factor without which they change nothing; null: they always do.
/// What only bends or tints the light that transmission lets through is left out.
constexpr std::pair<const char*, const char*> kMaterialExtensions[] = {
    {"KHR_materials_clearcoat", "clearcoatFactor"},
    {"KHR_materials_transmission", "transmissionFactor"},
    {"KHR_materials_diffuse_transmission", "diffuseTransmissionFactor"},
    {"KHR_materials_sheen", "sheenColorFactor"},
    {"KHR_materials_iridescence", "iridescenceFactor"},
    {"KHR_materials_pbrSpecularGlossiness", nullptr},
    {"KHR_materials_unlit", nullptr}};

/// A number or a list of them; 0 by default.
bool is_positive(const tinygltf::Value& factor) {
  const auto above = [](const tinygltf::Value& v) {
    return v.IsNumber() && v.GetNumberAsDouble() > 0.0;
  };
  for (std::size_t i = 0; i < factor.ArrayLen(); ++i)
    if (above(factor.Get(i))) return true;
  return above(factor);
}

bool has_effect(const tinygltf::Material& material, const char* name, const char* factor) {
  const auto found = material.extensions.find(name);
  if (found == material.extensions.end()) return false;
  return !factor || (found->second.Has(factor) && is_positive(found->second.Get(factor)));
}

/// Metals that are not so rough that a matt surface comes near.
bool is_metal(const mesh::Scene& scene, const mesh::Primitive& primitive) {
  for (std::size_t v = 0; v < primitive.mesh.vertex_count(); ++v) {
    const auto at_vertex = mesh::metallic_roughness_at_vertex(scene, primitive, v);
    if (at_vertex.metallic >= 0.5f && at_vertex.roughness < 0.9f) return true;
  }
  return false;
}

void add_materials(const Model& model, const mesh::Scene& scene, bool is_glossy,
                   std::vector<std::string>& features) {
  std::map<std::string, std::set<std::size_t>> left_out;  // the materials that have a feature
  std::set<std::size_t> metals;
  for (const mesh::Primitive& primitive : scene.primitives) {
    if (primitive.material < 0) continue;
    const auto index = static_cast<std::size_t>(primitive.material);
    const tinygltf::Material& material = model.materials[index];
    const auto& emission = material.emissiveFactor;
    if (material.normalTexture.index >= 0) left_out["normalTexture"].insert(index);
    if (std::any_of(emission.begin(), emission.end(), [](double c) { return c > 0.0; }))
      left_out["emission"].insert(index);
    for (const auto& [name, factor] : kMaterialExtensions)
      if (has_effect(material, name, factor)) left_out[name].insert(index);
    if (!is_glossy && is_metal(scene, primitive)) metals.insert(index);
  }
  const auto names = [&](const std::set<std::size_t>& materials) {
    std::vector<std::string> list;
    for (const std::size_t i : materials) list.push_back(mesh::material_name(scene, i));
    return listed(list);
  };
  std::vector<std::string> parts;
  for (const auto& [feature, materials] : left_out)
    parts.push_back(fmt::format("{} ({})", feature, names(materials)));
  if (!parts.empty())
    features.push_back(fmt::format("not baked of its materials: {}", fmt::join(parts, "; ")));
  if (!metals.empty())
    features.push_back("metals are baked matt: " + names(metals) +
                       "; --mode matrix has them shine");
}

}  // namespace

std::vector<std::string> Document::unbaked_features(const mesh::Scene& scene,
                                                    bool is_glossy) const {
  const Model model = read_model(*state_);
  std::vector<std::string> features;
  add_motion(model, features);
  add_materials(model, scene, is_glossy, features);
  return features;
}

}  // namespace prt::gltf
