#include "gltf/state.h"

#include <ImathQuat.h>

#include <array>
#include <set>

#include "core/error.h"
#include "core/log.h"

namespace prt::gltf {

namespace {

Matrix4 local_transform(const State& state, std::size_t index) {
  const Json& node = state.element("nodes", index);
  const Where where = state.where("node", index);
  Matrix4 matrix;
  // glTF's column-major matrices of column vectors are Imath's row-major ones of row vectors.
  if (read_numbers(node, "matrix", 16, matrix.getValue(), where)) return matrix;
  Vec3 scale(1.0f), translation(0.0f);
  std::array<float, 4> q{0.0f, 0.0f, 0.0f, 1.0f};
  read_numbers(node, "scale", 3, &scale.x, where);
  read_numbers(node, "rotation", 4, q.data(), where);
  read_numbers(node, "translation", 3, &translation.x, where);
  Matrix4 scaling, rotation;
  scaling.setScale(scale);
  if (node.contains("rotation")) {
    rotation = Imath::Quatf(q[3], q[0], q[1], q[2]).normalized().toMatrix44();
  }
  matrix = scaling * rotation;
  for (int c = 0; c < 3; ++c) matrix[3][c] = translation[c];
  return matrix;
}

std::vector<std::size_t> root_nodes(const State& state) {
  const std::size_t scene_count = state.count("scenes");
  std::vector<std::size_t> roots;
  if (scene_count > 0) {
    const std::size_t scene = optional_count(state.root, "scene", 0, {state.file, "scene"});
    for (const Json& node : array_of(state.element("scenes", scene), "nodes")) {
      roots.push_back(node.get<std::size_t>());
    }
    return roots;
  }
  std::set<std::size_t> children;
  for (const Json& node : array_of(state.root, "nodes")) {
    for (const Json& child : array_of(node, "children")) children.insert(child.get<std::size_t>());
  }
  for (std::size_t i = 0; i < state.count("nodes"); ++i) {
    if (!children.contains(i)) roots.push_back(i);
  }
  return roots;
}

}  // namespace

std::span<const std::byte> State::view_bytes(std::size_t buffer_view) const {
  const Json& view = element("bufferViews", buffer_view);
  const auto buffer = view.at("buffer").get<std::size_t>();
  return std::span(buffers.at(buffer))
      .subspan(view.value("byteOffset", std::size_t{0}), view.at("byteLength").get<std::size_t>());
}

std::vector<PrimitiveUse> list_primitives(const State& state) {
  struct Visit {
    std::size_t node;
    Matrix4 world_from_parent;
  };
  std::vector<PrimitiveUse> uses;
  std::vector<Visit> stack;
  const auto push_reversed = [&](const std::vector<std::size_t>& nodes, const Matrix4& matrix) {
    for (auto i = nodes.rbegin(); i != nodes.rend(); ++i) stack.push_back({*i, matrix});
  };
  push_reversed(root_nodes(state), Matrix4());
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    const Json& node = state.element("nodes", visit.node);
    const Matrix4 world_from_local = local_transform(state, visit.node) * visit.world_from_parent;
    if (const auto mesh =
            optional_index(node, "mesh", state.count("meshes"), state.where("node", visit.node))) {
      const Json& primitives = state.element("meshes", *mesh).at("primitives");
      for (std::size_t p = 0; p < primitives.size(); ++p) {
        if (primitive_mode(state, primitives[p]) >= kTriangles) {
          uses.push_back({visit.node, *mesh, p, world_from_local});
        } else {
          log::debug("{}: mesh {}: primitive {} draws points or lines, ignored", state.file, *mesh,
                     p);
        }
      }
    }
    std::vector<std::size_t> children;
    for (const Json& child : array_of(node, "children")) {
      children.push_back(child.get<std::size_t>());
    }
    push_reversed(children, world_from_local);
  }
  return uses;
}

const Json& primitive_of(const State& state, const PrimitiveUse& use) {
  return state.element("meshes", use.mesh).at("primitives").at(use.primitive);
}

Json& primitive_of(State& state, const PrimitiveUse& use) {
  return state.root["meshes"][use.mesh]["primitives"][use.primitive];
}

std::size_t primitive_mode(const State& state, const Json& primitive) {
  return optional_count(primitive, "mode", kTriangles, {state.file, "primitive"});
}

}  // namespace prt::gltf
