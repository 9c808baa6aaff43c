#include <fmt/format.h>

#include "gltf/check.h"

namespace prt::gltf {

namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

// Node numbers of an array of them.
std::vector<std::size_t> read_nodes(const State& state, const Json& object, const char* key,
                                    const Where& where) {
  std::vector<std::size_t> nodes;
  const Json* array = find(object, key);
  if (!array) return nodes;
  const std::size_t count = state.count("nodes");
  const auto valid = [&](const Json& node) {
    return node.is_number_unsigned() && node.get<std::size_t>() < count;
  };
  if (!array->is_array() || !std::all_of(array->begin(), array->end(), valid)) {
    reject_at(where, fmt::format("bad \"{}\"", key), {},
              fmt::format("an array of numbers less than {}", count));
  }
  for (const Json& node : *array) nodes.push_back(node.get<std::size_t>());
  return nodes;
}

}  // namespace

void check_nodes(const State& state) {
  const std::size_t count = state.count("nodes");
  std::vector<std::size_t> parent(count, kNone);
  for (std::size_t i = 0; i < count; ++i) {
    const Where where = state.where("node", i);
    const Json& node = state.element("nodes", i);
    optional_index(node, "mesh", state.count("meshes"), where);
    check_numbers(node, "matrix", 16, where);
    check_numbers(node, "rotation", 4, where);
    check_numbers(node, "scale", 3, where);
    check_numbers(node, "translation", 3, where);
    for (const std::size_t child : read_nodes(state, node, "children", where)) {
      if (parent[child] != kNone) {
        reject_at(state.where("node", child), "a node with two parents",
                  fmt::format("nodes {} and {}", parent[child], i));
      }
      parent[child] = i;
    }
  }
  // Depth of each node by walking up; a walk longer than the limit is a cycle or too deep.
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t depth = 0;
    for (std::size_t node = i; parent[node] != kNone; node = parent[node]) {
      if (++depth > state.limits.max_node_depth) {
        reject_at(state.where("node", i), "node cycle, or nodes nested too deeply", {},
                  fmt::format("at most {} ancestors and none of them itself",
                              state.limits.max_node_depth));
      }
    }
  }
  for (std::size_t i = 0; i < state.count("scenes"); ++i) {
    std::vector<bool> listed(count);
    const Where where = state.where("scene", i);
    for (const std::size_t node : read_nodes(state, state.element("scenes", i), "nodes", where)) {
      if (listed[node] || parent[node] != kNone) {
        reject_at(where, "a node that the scene shows twice, or that has a parent",
                  fmt::format("node {}", node));
      }
      listed[node] = true;
    }
  }
  if (state.count("scenes") > 0) {
    optional_index(state.root, "scene", state.count("scenes"), {state.file, "default scene"});
  }
}

}  // namespace prt::gltf
