#include <fmt/format.h>

#include "core/checked.h"
#include "gltf/accessor.h"
#include "gltf/check.h"

namespace prt::gltf {

namespace {

// Of meshes that more than one node uses, once for each.
constexpr std::size_t kMaxCopiedJson = std::size_t{1} << 26;

[[noreturn]] void reject_size(const Where& where, const std::string& what, const std::string& found,
                              std::size_t most) {
  reject_at(where, what, found, fmt::format("at most {}", most));
}

// Nodes may share a mesh: importing gives each its own. Counted before anything is listed or
// copied.
void check_instances(const State& state) {
  std::vector<std::size_t> uses(state.count("meshes"));
  for (const Json& node : array_of(state.root, "nodes")) {
    if (const Json* mesh = find(node, "mesh")) ++uses[mesh->get<std::size_t>()];
  }
  std::size_t primitives = 0, copied = 0;
  for (std::size_t m = 0; m < uses.size(); ++m) {
    const Json& mesh = state.element("meshes", m);
    primitives = checked_add(primitives, checked_multiply(uses[m], mesh["primitives"].size()));
    if (uses[m] > 1) copied = checked_add(copied, checked_multiply(uses[m], mesh.dump().size()));
  }
  const Where where{state.file, "nodes"};
  if (primitives > state.limits.max_primitive_count) {
    reject_size(where, "too many primitives", std::to_string(primitives),
                state.limits.max_primitive_count);
  }
  if (copied > kMaxCopiedJson) {
    reject_size(where, "meshes used too often", fmt::format("{} bytes of JSON", copied),
                kMaxCopiedJson);
  }
}

}  // namespace

void check_size(const State& state) {
  check_instances(state);
  const Model model = read_model(state);
  std::size_t total = 0;
  for (const PrimitiveUse& use : list_primitives(model)) {
    const tinygltf::Primitive& primitive = primitive_of(model, use);
    const auto add = [&](int accessor) {
      total = checked_add(total, accessor_of(model, accessor).count);
    };
    for (const auto& [name, accessor] : primitive.attributes) add(accessor);
    if (primitive.indices >= 0) add(primitive.indices);
    if (total > state.limits.max_element_count) {
      reject_size({state.file, "scene"}, "too many vertices and indices", std::to_string(total),
                  state.limits.max_element_count);
    }
  }
}

}  // namespace prt::gltf
