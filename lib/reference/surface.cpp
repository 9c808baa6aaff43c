#include "reference/surface.h"

#include <ImathBox.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/log.h"

namespace prt::reference {

namespace {

/// Cosine that eyes are raised to: BRDFs are 0 on the horizon itself.
constexpr float kHorizon = 1e-3f;

Vec3 interpolate(const Vec3& a, const Vec3& b, const Vec3& c, float u, float v) {
  return a * (1.0f - u - v) + b * u + c * v;
}

float largest_coordinate(const Vec3& p) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

/// Any frame around a unit normal [Duff et al. 2017].
mesh::Frame frame_around(const Vec3& n) {
  const float sign = std::copysign(1.0f, n.z);
  const float a = -1.0f / (sign + n.z);
  const float b = n.x * n.y * a;
  return {{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

/// The vertices' frames, interpolated and made orthonormal around the unit normal.
mesh::Frame tangent_frame(const mesh::TriangleMesh& mesh,
                          const std::array<std::uint32_t, 3>& corners, float u, float v,
                          const Vec3& normal) {
  const mesh::Frame a = mesh::frame_at_vertex(mesh, corners[0]),
                    b = mesh::frame_at_vertex(mesh, corners[1]),
                    c = mesh::frame_at_vertex(mesh, corners[2]);
  Vec3 x = interpolate(a.x, b.x, c.x, u, v);
  x = (x - normal * normal.dot(x)).normalized();
  if (x == Vec3(0.0f)) return frame_around(normal);
  const Vec3 y = normal.cross(x);
  return {x, y.dot(interpolate(a.y, b.y, c.y, u, v)) < 0.0f ? -y : y, normal};
}

mesh::Frame turned(const mesh::Frame& frame, float angle) {
  const float c = std::cos(angle), s = std::sin(angle);
  return {frame.x * c + frame.y * s, frame.y * c - frame.x * s, frame.z};
}

}  // namespace

SurfaceLookup::SurfaceLookup(const mesh::Scene& scene, std::string_view brdf) : scene_(scene) {
  make_reflectors(brdf);
  add_triangles();
}

void SurfaceLookup::make_reflectors(std::string_view text) {
  if (const auto brdf = brdf::parse_brdf(text)) {
    reflectors_.assign(scene_.materials.size() + 1, Reflector(*brdf));
  } else {
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
      if (scene_.materials[i].has_unread_textures) {
        log::warning("{}: textures of specular and anisotropy are ignored",
                     mesh::material_name(scene_, i));
      }
      reflectors_.emplace_back(scene_.materials[i]);
    }
    reflectors_.emplace_back(mesh::default_material());
  }
  for (const Reflector& reflector : reflectors_) is_isotropic_.push_back(reflector.is_isotropic());
}

void SurfaceLookup::add_triangles() {
  positions_.reserve(scene_.vertex_count());
  indices_.reserve(3 * scene_.triangle_count());
  primitive_of_triangle_.reserve(scene_.triangle_count());
  Imath::Box3f box;
  for (std::size_t p = 0; p < scene_.primitives.size(); ++p) {
    const mesh::TriangleMesh& mesh = scene_.primitives[p].mesh;
    const auto first_vertex = static_cast<std::uint32_t>(positions_.size());
    first_triangle_.push_back(static_cast<std::uint32_t>(primitive_of_triangle_.size()));
    positions_.insert(positions_.end(), mesh.positions.begin(), mesh.positions.end());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      if (!is_finite(mesh.positions[v])) {
        throw_bad_input("position is not finite",
                        {.element = fmt::format("{}, vertex {}", scene_.primitives[p].name, v)});
      }
      box.extendBy(mesh.positions[v]);
    }
    for (const std::uint32_t index : mesh.indices) indices_.push_back(first_vertex + index);
    primitive_of_triangle_.insert(primitive_of_triangle_.end(), mesh.triangle_count(),
                                  static_cast<std::uint32_t>(p));
  }
  if (!box.isEmpty()) centre_ = box.min * 0.5f + box.max * 0.5f;
  if (!box.isEmpty()) scale_ = ray::unit_scale(largest_coordinate(box.max * 0.5f - box.min * 0.5f));
  for (Vec3& position : positions_) position = (position - centre_) * scale_;
}

std::optional<SurfacePoint> SurfaceLookup::surface_at(const ray::Hit& hit,
                                                      const Vec3& direction) const {
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

  SurfacePoint point;
  point.origin =
      ray::offset_origin(interpolate(a, b, c, hit.u, hit.v), geometric_normal, magnitude);
  const std::size_t material = primitive.material < 0
                                   ? reflectors_.size() - 1
                                   : static_cast<std::size_t>(primitive.material);
  point.reflector = &reflectors_[material];
  point.frame = is_isotropic_[material]
                    ? frame_around(normal)
                    : turned(tangent_frame(primitive.mesh, corners, hit.u, hit.v, normal),
                             point.reflector->rotation());
  point.eye = point.local_from_world(-direction);
  point.eye.z = std::max(point.eye.z, kHorizon);
  point.eye.normalize();
  point.albedo = mesh::albedo_at_point(scene_, primitive, triangle, hit.u, hit.v);
  point.reflection = mesh::metallic_roughness_at_point(scene_, primitive, triangle, hit.u, hit.v);
  return point;
}

}  // namespace prt::reference
