#include "gltf/geometry.h"

#include <fmt/format.h>

#include "core/error.h"
#include "gltf/accessor.h"

namespace prt::gltf {

namespace {

std::optional<std::size_t> attribute(const State& state, const Json& primitive, const char* name,
                                     const Where& where) {
  return optional_index(primitive.at("attributes"), name, state.count("accessors"), where);
}

// An attribute of the given number of components (COLOR_0 may have 3 or 4) as vectors.
template <class Vec>
std::vector<Vec> read_vectors(const State& state, const Json& primitive, const char* name,
                              const Where& where) {
  std::vector<Vec> vectors;
  const auto accessor = attribute(state, primitive, name, where);
  if (!accessor) return vectors;
  const std::size_t components = accessor_components(state, *accessor);
  const bool color_without_alpha = std::string_view(name) == "COLOR_0" && components == 3;
  if (components != Vec::dimensions() && !color_without_alpha) {
    throw_bad_input(fmt::format("{} of a wrong type", name),
                    {.file = where.file,
                     .element = where.element,
                     .found = fmt::format("{} components", components),
                     .expected = fmt::format("{}", Vec::dimensions())});
  }
  const std::vector<float> values = read_floats(state, *accessor);
  vectors.assign(accessor_count(state, *accessor), Vec(1.0f));
  for (std::size_t i = 0; i < values.size(); ++i) {
    vectors[i / components][static_cast<int>(i % components)] = values[i];
  }
  return vectors;
}

// Corners 0, 1, 2, … when the primitive has no indices.
std::vector<std::uint32_t> read_corners(const State& state, const Json& primitive,
                                        std::size_t vertex_count, const Where& where) {
  std::vector<std::uint32_t> corners;
  const auto accessor = optional_index(primitive, "indices", state.count("accessors"), where);
  if (accessor) {
    corners = read_unsigned(state, *accessor);
  } else {
    for (std::uint32_t i = 0; i < vertex_count; ++i) corners.push_back(i);
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (corners[i] < vertex_count) continue;
    throw_bad_input("index past the last vertex",
                    {.file = where.file,
                     .element = fmt::format("{}: index {}", where.element, i),
                     .found = std::to_string(corners[i]),
                     .expected = fmt::format("less than {}", vertex_count)});
  }
  return corners;
}

std::vector<std::uint32_t> triangulate(std::vector<std::uint32_t> corners, std::size_t mode) {
  if (mode == kTriangles) {
    corners.resize(corners.size() / 3 * 3);
    return corners;
  }
  std::vector<std::uint32_t> triangles;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const std::size_t odd = i % 2;  // strips turn every other triangle round
    const std::array<std::uint32_t, 3> triangle =
        mode == kTriangleStrip ? std::array{corners[i - 2], corners[i - 1 + odd], corners[i - odd]}
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
  make_object(primitive, "attributes")[name] = add_floats(state, type, values, kVertices);
}

}  // namespace

mesh::TriangleMesh read_geometry(const State& state, const Json& primitive, const Where& where) {
  mesh::TriangleMesh mesh;
  mesh.positions = read_vectors<Vec3>(state, primitive, "POSITION", where);
  mesh.normals = read_vectors<Vec3>(state, primitive, "NORMAL", where);
  mesh.tangents = read_vectors<Vec4>(state, primitive, "TANGENT", where);
  mesh.texcoords = read_vectors<Vec2>(state, primitive, "TEXCOORD_0", where);
  mesh.colors = read_vectors<Vec4>(state, primitive, "COLOR_0", where);
  if (mesh.positions.empty()) {
    throw_bad_input("no positions", {.file = where.file, .element = where.element});
  }
  mesh.indices = triangulate(read_corners(state, primitive, mesh.vertex_count(), where),
                             primitive_mode(state, primitive));
  return mesh;
}

void write_geometry(State& state, Json& primitive, const mesh::TriangleMesh& mesh) {
  write_vectors(state, primitive, "POSITION", "VEC3", mesh.positions);
  write_vectors(state, primitive, "NORMAL", "VEC3", mesh.normals);
  write_vectors(state, primitive, "TANGENT", "VEC4", mesh.tangents);
  write_vectors(state, primitive, "TEXCOORD_0", "VEC2", mesh.texcoords);
  write_vectors(state, primitive, "COLOR_0", "VEC4", mesh.colors);
  primitive["indices"] = add_indices(state, mesh.indices);
  set_bounds(state, primitive["attributes"]["POSITION"].get<std::size_t>());
}

}  // namespace prt::gltf
