#include "reference/surface.h"

namespace prt::reference {

namespace {

Vec3 interpolate(const std::vector<Vec3>& values, const std::array<std::uint32_t, 3>& corners,
                 float u, float v) {
  return values[corners[0]] * (1.0f - u - v) + values[corners[1]] * u + values[corners[2]] * v;
}

}  // namespace

SurfaceLookup::SurfaceLookup(const mesh::Scene& scene) : scene_(scene) {
  positions_.reserve(scene.vertex_count());
  indices_.reserve(3 * scene.triangle_count());
  primitive_of_triangle_.reserve(scene.triangle_count());
  for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
    const mesh::TriangleMesh& mesh = scene.primitives[p].mesh;
    const auto first_vertex = static_cast<std::uint32_t>(positions_.size());
    first_triangle_.push_back(static_cast<std::uint32_t>(primitive_of_triangle_.size()));
    positions_.insert(positions_.end(), mesh.positions.begin(), mesh.positions.end());
    for (const std::uint32_t index : mesh.indices) indices_.push_back(first_vertex + index);
    primitive_of_triangle_.insert(primitive_of_triangle_.end(), mesh.triangle_count(),
                                  static_cast<std::uint32_t>(p));
  }
}

std::optional<SurfacePoint> SurfaceLookup::surface_at(const ray::Hit& hit) const {
  const std::uint32_t primitive_index = primitive_of_triangle_[hit.triangle];
  const mesh::Primitive& primitive = scene_.primitives[primitive_index];
  const bool double_sided =
      primitive.material >= 0 &&
      scene_.materials[static_cast<std::size_t>(primitive.material)].double_sided;
  if (hit.back_face && !double_sided) return std::nullopt;

  const mesh::TriangleMesh& mesh = primitive.mesh;
  const std::size_t triangle = hit.triangle - first_triangle_[primitive_index];
  const auto corners = mesh.triangle(triangle);
  const Vec3& p0 = mesh.positions[corners[0]];
  Vec3 geometric_normal =
      (mesh.positions[corners[1]] - p0).cross(mesh.positions[corners[2]] - p0).normalized();
  Vec3 normal = interpolate(mesh.normals, corners, hit.u, hit.v).normalized();
  if (normal == Vec3(0.0f)) normal = geometric_normal;
  // The bake leaves a vertex on the side of its normal, whatever the winding says: so does this.
  if (geometric_normal.dot(normal) < 0.0f) geometric_normal.negate();
  if (hit.back_face) {
    normal.negate();
    geometric_normal.negate();
  }
  const Vec3 position = interpolate(mesh.positions, corners, hit.u, hit.v);
  return SurfacePoint{ray::offset_origin(position, geometric_normal), normal,
                      mesh::albedo_at_point(scene_, primitive, triangle, hit.u, hit.v)};
}

}  // namespace prt::reference
