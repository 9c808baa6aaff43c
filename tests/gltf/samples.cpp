#include "gltf/samples.h"

#include <span>

namespace prt::gltf::samples {

namespace {

mesh::TriangleMesh triangle(float z) {
  mesh::TriangleMesh mesh;
  mesh.positions = {{0, 0, z}, {1, 0, z}, {0, 1, z}};
  mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  mesh.texcoords = {{0, 1}, {1, 1}, {0, 0}};
  mesh.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
  mesh.indices = {0, 1, 2};
  return mesh;
}

}  // namespace

mesh::Scene scene() {
  mesh::Scene scene;
  scene.primitives.push_back(
      {.name = "first", .mesh = triangle(0.0f), .material = 0, .mesh_index = 0});
  scene.primitives.push_back(
      {.name = "second", .mesh = triangle(0.1f), .material = 1, .mesh_index = 1});
  mesh::Material textured, plain;
  textured.name = "textured";
  textured.base_color_image = 0;
  textured.wrap_s = mesh::Wrap::clamp;
  textured.wrap_t = mesh::Wrap::mirror;
  plain.name = "plain";
  plain.base_color = {0.25f, 0.5f, 0.75f, 1.0f};
  plain.double_sided = true;
  scene.materials = {textured, plain};
  image::Image image(2, 2, 3);
  image.pixels = {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
  scene.images = {image};
  return scene;
}

PrecomputedTransfer transfer(std::size_t vertex_count, int cluster_count, int component_count) {
  PrecomputedTransfer transfer;
  transfer.band_count = 3;
  transfer.channel_count = 3;
  transfer.mesh_hash = "0123456789abcdef";
  cpca::Encoding& encoding = transfer.encoding;
  encoding.point_count = vertex_count;
  encoding.dimension = 27;
  encoding.cluster_count = cluster_count;
  encoding.component_count = component_count;
  const auto fill = [](std::vector<float>& values, std::size_t count, float scale) {
    for (std::size_t i = 0; i < count; ++i) {
      values.push_back(scale * static_cast<float>(i % 101) - 1.0f);
    }
  };
  const auto clusters = static_cast<std::size_t>(cluster_count);
  const auto components = static_cast<std::size_t>(component_count);
  fill(encoding.means, clusters * 27, 0.1f);
  fill(encoding.bases, clusters * components * 27, 0.03f);
  fill(encoding.weights, vertex_count * components, 0.7f);
  for (std::size_t i = 0; i < vertex_count; ++i) {
    encoding.cluster_of_point.push_back(static_cast<std::uint32_t>(i % clusters));
  }
  return transfer;
}

nlohmann::ordered_json triangle_json() {
  return nlohmann::ordered_json::parse(R"({
    "asset": {"version": "2.0"},
    "scene": 0,
    "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 2}, "indices": 1}]}],
    "buffers": [{"byteLength": 42, "uri": "data:application/octet-stream;base64,)"
                                       "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA"
                                       R"("}],
    "bufferViews": [{"buffer": 0, "byteLength": 36},
                    {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
    "accessors": [
      {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
       "min": [0, 0, 0], "max": [1, 1, 0]},
      {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
      {"componentType": 5126, "count": 3, "type": "VEC3",
       "sparse": {"count": 3, "indices": {"bufferView": 1, "componentType": 5123},
                  "values": {"bufferView": 0}}}]
  })");
}

Document parse(const nlohmann::ordered_json& json) {
  const std::string text = json.dump();
  return Document::parse(std::as_bytes(std::span(text)), "a.gltf");
}

}  // namespace prt::gltf::samples
