// Document::unbaked_features.
#include <fmt/format.h>

#include <algorithm>
#include <set>

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

}  // namespace

std::vector<std::string> Document::unbaked_features() const {
  const Model model = read_model(*state_);
  std::vector<std::string> features;
  add_motion(model, features);
  return features;
}

}  // namespace prt::gltf
