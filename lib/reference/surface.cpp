#include "reference/surface.h"

#include <ImathBox.h>

#include <algorithm>
#include <cmath>

namespace prt::reference {

namespace {

Vec3 interpolate(const Vec3& a, const Vec3& b, const Vec3& c, float u, float v) {
  return a * (1.0f - u - v) + b * u + c * v;
}

float largest_coordinate(const Vec3& p) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

}  // namespace

SurfaceLookup::SurfaceLookup(const mesh::Scene& scene) : scene_(scene) {
  positions_.reserve(scene.vertex_count());
  indices_.reserve(3 * scene.triangle_count());
  primitive_of_triangle_.reserve(scene.triangle_count());
  Imath::Box3f box;
  for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
    const mesh::TriangleMesh& mesh = scene.primitives[p].mesh;
    const auto first_vertex = static_cast<std::uint32_t>(positions_.size());
    first_triangle_.push_back(static_cast<std::uint32_t>(primitive_of_triangle_.size()));
    positions_.insert(positions_.end(), mesh.positions.begin(), mesh.positions.end());
    for (const Vec3& position : mesh.positions) box.extendBy(position);
    for (const std::uint32_t index : mesh.indices) indices_.push_back(first_vertex + index);
    primitive_of_triangle_.insert(primitive_of_triangle_.end(), mesh.triangle_count(),
                                  static_cast<std::uint32_t>(p));
  }
  if (!box.isEmpty()) centre_ = box.min * 0.5f + box.max * 0.5f;
  for (Vec3& position : positions_) position -= centre_;
}

std::optional<SurfacePoint> SurfaceLookup::surface_at(const ray::Hit& hit) const {
  if (hit.back_face) return std::nullopt;
  const std::uint32_t primitive_index = primitive_of_triangle_[hit.triangle];
  const mesh::Primitive& primitive = scene_.primitives[primitive_index];
  const std::size_t triangle = hit.triangle - first_triangle_[primitive_index];
  const auto corners = primitive.mesh.triangle(triangle);
  const std::uint32_t* const indices = &indices_[3 * std::size_t{hit.triangle}];
  const Vec3 &a = positions_[indices[0]], &b = positions_[indices[1]], &c = positions_[indices[2]];
  Vec3 geometric_normal = (b - a).cross(c - a).normalized();
  const std::vector<Vec3>& normals = primitive.mesh.normals;
  Vec3 normal =
      interpolate(normals[corners[0]], normals[corners[1]], normals[corners[2]], hit.u, hit.v)
          .normalized();
  if (normal == Vec3(0.0f)) normal = geometric_normal;
  // The bake leaves a vertex on the side of its normal, whatever the winding says: so does this.
  if (geometric_normal.dot(normal) < 0.0f) geometric_normal.negate();
  const float magnitude =
      std::max({largest_coordinate(a), largest_coordinate(b), largest_coordinate(c)});
  const Vec3 position = interpolate(a, b, c, hit.u, hit.v);
  return SurfacePoint{ray::offset_origin(position, geometric_normal, magnitude), normal,
                      mesh::albedo_at_point(scene_, primitive, triangle, hit.u, hit.v)};
}

}  // namespace prt::reference
