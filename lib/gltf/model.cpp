#include "gltf/model.h"

#include <ImathQuat.h>
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

#include "core/error.h"
#include "core/log.h"
#include "core/report.h"

namespace prt::gltf {

namespace {

// Buffers and images, whose bytes are ours already, are not shown to tinygltf, nor is what prtkit
// does not use: it has less to reject and nothing to open.
constexpr const char* kReadArrays[] = {"accessors", "bufferViews", "materials", "meshes",
                                       "nodes",     "samplers",    "scenes",    "textures"};

Json readable_part(const Json& root) {
  Json part{{"asset", {{"version", "2.0"}}}};
  for (const char* name : kReadArrays) {
    if (const Json* array = find(root, name)) part[name] = *array;
  }
  if (const Json* scene = find(root, "scene")) part["scene"] = *scene;
  if (const Json* transfer = find_transfer(root)) {
    part["extensions"][kTransferExtension] = *transfer;
  }
  return part;
}

Matrix4 local_transform(const tinygltf::Node& node) {
  Matrix4 matrix;
  // glTF's column-major matrices of column vectors are Imath's row-major ones of row vectors.
  if (!node.matrix.empty()) {
    std::copy(node.matrix.begin(), node.matrix.end(), matrix.getValue());
    return matrix;
  }
  const auto &s = node.scale, &q = node.rotation, &t = node.translation;
  if (!s.empty()) matrix.setScale(Vec3(s[0], s[1], s[2]));
  if (!q.empty()) matrix *= Imath::Quatf(q[3], q[0], q[1], q[2]).normalized().toMatrix44();
  if (!t.empty()) std::copy(t.begin(), t.end(), matrix[3]);
  return matrix;
}

std::vector<int> root_nodes(const Model& model) {
  if (!model.scenes.empty()) {
    return model.scenes[static_cast<std::size_t>(std::max(model.defaultScene, 0))].nodes;
  }
  std::set<int> children;
  for (const tinygltf::Node& node : model.nodes) {
    children.insert(node.children.begin(), node.children.end());
  }
  std::vector<int> roots;
  for (int i = 0; i < static_cast<int>(model.nodes.size()); ++i) {
    if (!children.contains(i)) roots.push_back(i);
  }
  return roots;
}

}  // namespace

std::span<const std::byte> Model::view_bytes(int buffer_view) const {
  const tinygltf::BufferView& view = bufferViews.at(static_cast<std::size_t>(buffer_view));
  return std::span(state.buffers.at(static_cast<std::size_t>(view.buffer)))
      .subspan(view.byteOffset, view.byteLength);
}

Model read_model(const State& state) {
  Model model{{}, state};
  const std::string text = json_text(readable_part(state.root));
  if (text.size() > std::numeric_limits<unsigned>::max()) {
    throw_bad_input("too much JSON", {.file = state.file});
  }
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks({});  // none: no file is opened
  std::string errors, warnings;
  const bool good = loader.LoadASCIIFromString(&model, &errors, &warnings, text.data(),
                                               static_cast<unsigned>(text.size()), "", 0);
  // It leaves out what it cannot read and says so, which would shift numbers.
  if (!good || !errors.empty()) {
    throw_bad_input(fmt::format("bad glTF: {}", errors.substr(0, errors.find('\n'))),
                    {.file = state.file});
  }
  return model;
}

std::vector<PrimitiveUse> list_primitives(const Model& model) {
  struct Visit {
    std::size_t node;
    Matrix4 world_from_parent;
  };
  std::vector<PrimitiveUse> uses;
  std::vector<Visit> stack;
  const auto push_reversed = [&](const std::vector<int>& nodes, const Matrix4& matrix) {
    for (auto i = nodes.rbegin(); i != nodes.rend(); ++i) {
      stack.push_back({static_cast<std::size_t>(*i), matrix});
    }
  };
  push_reversed(root_nodes(model), Matrix4());
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    const tinygltf::Node& node = model.nodes[visit.node];
    const Matrix4 world_from_local = local_transform(node) * visit.world_from_parent;
    if (node.mesh >= 0) {
      const auto mesh = static_cast<std::size_t>(node.mesh);
      for (std::size_t p = 0; p < model.meshes[mesh].primitives.size(); ++p) {
        if (model.meshes[mesh].primitives[p].mode >= TINYGLTF_MODE_TRIANGLES) {
          uses.push_back({visit.node, mesh, p, node.skin < 0 ? world_from_local : Matrix4()});
        } else {
          log::debug("{}: mesh {}: primitive {} draws points or lines, ignored", model.state.file,
                     mesh, p);
        }
      }
    }
    push_reversed(node.children, world_from_local);
  }
  return uses;
}

const tinygltf::Primitive& primitive_of(const Model& model, const PrimitiveUse& use) {
  return model.meshes.at(use.mesh).primitives.at(use.primitive);
}

Json& primitive_of(State& state, const PrimitiveUse& use) {
  return state.root["meshes"][use.mesh]["primitives"][use.primitive];
}

Where where_of(const Model& model, const PrimitiveUse& use) {
  return {model.state.file, fmt::format("mesh {}: primitive {}", use.mesh, use.primitive)};
}

std::string name_of(const Model& model, const PrimitiveUse& use) {
  const std::string &node = model.nodes[use.node].name, &mesh = model.meshes[use.mesh].name;
  if (!node.empty()) return node;
  return mesh.empty() ? fmt::format("mesh {}", use.mesh) : mesh;
}

}  // namespace prt::gltf
