#include "transfer/scene_index.h"

#include <ImathBox.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "transfer/spatial_order.h"

namespace prt::transfer {

namespace {

float largest_coordinate(const Vec3& p) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

void check_vertices(const mesh::Primitive& primitive) {
  const mesh::TriangleMesh& mesh = primitive.mesh;
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    if (is_finite(mesh.positions[i]) && is_finite(mesh.normals[i])) continue;
    throw_bad_input("position or normal is not finite",
                    {.element = fmt::format("{}, vertex {}", primitive.name, i)});
  }
}

}  // namespace

SceneIndex::SceneIndex(const mesh::Scene& scene)
    : scene_(scene), vertex_offsets_{0}, triangle_offsets_{0} {
  Imath::Box3f box;
  for (const mesh::Primitive& primitive : scene.primitives) {
    check_vertices(primitive);
    for (const Vec3& p : primitive.mesh.positions) box.extendBy(p);
    vertex_offsets_.push_back(vertex_count() + primitive.mesh.vertex_count());
    triangle_offsets_.push_back(triangle_count() + primitive.mesh.triangle_count());
  }
  if (std::max(vertex_count(), triangle_count()) >= ray::kNoHit) {
    throw_failed("too many vertices or triangles", {.expected = "fewer than 2^32 - 1"});
  }
  if (vertex_count() > 0) centre_ = box.min * 0.5f + box.max * 0.5f;

  std::vector<Vec3> positions(vertex_count());
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = position(i);
  std::vector<std::uint32_t> indices;
  indices.reserve(3 * triangle_count());
  for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
    for (std::uint32_t i : scene.primitives[p].mesh.indices) {
      indices.push_back(i + static_cast<std::uint32_t>(vertex_offsets_[p]));
    }
  }
  engine_ = ray::make_embree_engine({positions, indices});
  vertex_order_ = spatial_order(positions);

  magnitudes_.assign(vertex_count(), 0.0f);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    float largest = 0.0f;
    for (std::size_t k = i; k < i + 3; ++k) {
      largest = std::max(largest, largest_coordinate(positions[indices[k]]));
    }
    for (std::size_t k = i; k < i + 3; ++k) {
      magnitudes_[indices[k]] = std::max(magnitudes_[indices[k]], largest);
    }
  }
}

SceneIndex::Place SceneIndex::place(const std::vector<std::size_t>& offsets, std::size_t number) {
  const auto next = std::upper_bound(offsets.begin(), offsets.end(), number);
  const auto primitive = static_cast<std::size_t>(next - offsets.begin()) - 1;
  return {primitive, number - offsets[primitive]};
}

const Vec3& SceneIndex::normal(std::size_t vertex) const {
  const Place at = vertex_place(vertex);
  return scene_.primitives[at.primitive].mesh.normals[at.local];
}

Vec3 SceneIndex::position(std::size_t vertex) const {
  const Place at = vertex_place(vertex);
  return scene_.primitives[at.primitive].mesh.positions[at.local] - centre_;
}

Vec3 SceneIndex::ray_origin(std::size_t vertex) const {
  return ray::offset_origin(position(vertex), normal(vertex), magnitudes_[vertex]);
}

std::array<std::uint32_t, 3> SceneIndex::triangle(std::size_t triangle) const {
  const Place at = triangle_place(triangle);
  std::array<std::uint32_t, 3> corners = scene_.primitives[at.primitive].mesh.triangle(at.local);
  for (std::uint32_t& i : corners) i += static_cast<std::uint32_t>(vertex_offsets_[at.primitive]);
  return corners;
}

}  // namespace prt::transfer
