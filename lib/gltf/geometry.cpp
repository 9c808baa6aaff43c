#include "gltf/geometry.h"

#include <fmt/format.h>

#include <cmath>

#include "gltf/accessor.h"

namespace prt::gltf {

namespace {

// An attribute of the given number of components (COLOR_0 may have 3 or 4) as vectors.
template <class Vec>
std::vector<Vec> read_vectors(const Model& model, const tinygltf::Primitive& primitive,
                              const char* name, const Where& where) {
  std::vector<Vec> vectors;
  const auto found = primitive.attributes.find(name);
  if (found == primitive.attributes.end()) return vectors;
  const tinygltf::Accessor& accessor = accessor_of(model, found->second);
  const std::size_t components = component_count(accessor);
  const bool color_without_alpha = std::string_view(name) == "COLOR_0" && components == 3;
  if (components != Vec::dimensions() && !color_without_alpha) {
    reject_at(where, fmt::format("{} of a wrong type", name),
              fmt::format("{} components", components), fmt::format("{}", Vec::dimensions()));
  }
  const std::vector<float> values = read_floats(model, found->second);
  vectors.assign(accessor.count, Vec(1.0f));
  for (std::size_t i = 0; i < values.size(); ++i) {
    vectors[i / components][static_cast<int>(i % components)] = values[i];
  }
  return vectors;
}

// Corners 0, 1, 2, … when the primitive has no indices.
std::vector<std::uint32_t> read_corners(const Model& model, const tinygltf::Primitive& primitive,
                                        std::size_t vertex_count, const Where& where) {
  std::vector<std::uint32_t> corners;
  if (primitive.indices >= 0) {
    corners = read_unsigned(model, primitive.indices);
  } else {
    for (std::uint32_t i = 0; i < vertex_count; ++i) corners.push_back(i);
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (corners[i] < vertex_count) continue;
    reject_at({where.file, fmt::format("{}: index {}", where.element, i)},
              "index past the last vertex", std::to_string(corners[i]),
              fmt::format("less than {}", vertex_count));
  }
  return corners;
}

std::vector<std::uint32_t> triangulate(std::vector<std::uint32_t> corners, int mode) {
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    corners.resize(corners.size() / 3 * 3);
    return corners;
  }
  std::vector<std::uint32_t> triangles;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const std::size_t odd = i % 2;  // strips turn every other triangle round
    const std::array<std::uint32_t, 3> triangle =
        mode == TINYGLTF_MODE_TRIANGLE_STRIP
            ? std::array{corners[i - 2], corners[i - 1 + odd], corners[i - odd]}
            : std::array{corners[i - 1], corners[i], corners[0]};
    triangles.insert(triangles.end(), triangle.begin(), triangle.end());
  }
  return triangles;
}

template <class Vec>
void write_vectors(State& state, Json& primitive, const char* name, const char* type,
                   const std::vector<Vec>& vectors) {
  if (vectors.empty()) return;
  const std::span<const float> values(&vectors[0].x, vectors.size() * Vec::dimensions());
  make_object(primitive, "attributes")[name] =
      add_floats(state, type, values, TINYGLTF_TARGET_ARRAY_BUFFER);
}

}  // namespace

mesh::TriangleMesh read_geometry(const Model& model, const tinygltf::Primitive& primitive,
                                 const Where& where) {
  mesh::TriangleMesh mesh;
  mesh.positions = read_vectors<Vec3>(model, primitive, "POSITION", where);
  mesh.normals = read_vectors<Vec3>(model, primitive, "NORMAL", where);
  mesh.tangents = read_vectors<Vec4>(model, primitive, "TANGENT", where);
  mesh.texcoords = read_vectors<Vec2>(model, primitive, "TEXCOORD_0", where);
  mesh.colors = read_vectors<Vec4>(model, primitive, "COLOR_0", where);
  if (mesh.positions.empty()) {
    reject_at(where, "no positions");
  }
  mesh.indices =
      triangulate(read_corners(model, primitive, mesh.vertex_count(), where), primitive.mode);
  return mesh;
}

void check_transform(const Matrix4& world_from_local, const mesh::TriangleMesh& mesh,
                     const Where& where) {
  const auto reject = [&](const char* what) {
    reject_at(where, what, {}, {}, "Mend or remove the nodes that show it.");
  };
  const double determinant = Imath::M44d(world_from_local).determinant();
  if (determinant == 0.0 || !std::isfinite(determinant)) {
    reject("a transform that flattens the mesh");
  }
  for (const Vec3& p : mesh.positions) {
    if (!is_finite(transform_point(world_from_local, p))) {
      reject("a transform that moves a vertex out of the range of floats");
    }
  }
}

void write_geometry(State& state, Json& primitive, const mesh::TriangleMesh& mesh) {
  write_vectors(state, primitive, "POSITION", "VEC3", mesh.positions);
  write_vectors(state, primitive, "NORMAL", "VEC3", mesh.normals);
  write_vectors(state, primitive, "TANGENT", "VEC4", mesh.tangents);
  write_vectors(state, primitive, "TEXCOORD_0", "VEC2", mesh.texcoords);
  write_vectors(state, primitive, "COLOR_0", "VEC4", mesh.colors);
  primitive["indices"] = add_indices(state, mesh.indices);
  set_bounds(state, primitive["attributes"]["POSITION"].get<std::size_t>(),
             {&mesh.positions[0].x, 3 * mesh.positions.size()});
}

}  // namespace prt::gltf
