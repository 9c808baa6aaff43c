// What a ray has hit: the point, its frame and what it reflects, in the terms of the bake.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "mesh/frame.h"
#include "mesh/scene.h"
#include "ray/engine.h"
#include "reference/reflector.h"

namespace prt::reference {

/// A point that reflects. Incoming light is that of the hemisphere around the shading normal,
/// weighted by the cosine to it.
struct SurfacePoint {
  Vec3 origin;  ///< where its rays start: just off the triangle, on the side of the normal;
                ///< relative to the scene's centre, in units of 1 / scale()
  /// z is the shading normal, the normalised interpolation of the vertices'; x and y are the axes
  /// of the lobes, of interpolated tangents where the BRDF is anisotropic. May be left-handed.
  mesh::Frame frame;
  /// Where it is seen from, unit length, in the frame. An eye below the horizon of the shading
  /// normal is raised to it.
  Vec3 eye;
  Vec3 albedo;
  mesh::MetallicRoughness reflection;
  const Reflector* reflector;

  PointBrdf brdf() const { return reflector->at(albedo, reflection); }

  Vec3 local_from_world(const Vec3& w) const {
    return {w.dot(frame.x), w.dot(frame.y), w.dot(frame.z)};
  }
  Vec3 world_from_local(const Vec3& w) const {
    return frame.x * w.x + frame.y * w.y + frame.z * w.z;
  }
};

/// The triangles of a scene, numbered through in the order of its primitives. Keeps a reference to
/// the scene.
class SurfaceLookup {
 public:
  /// `brdf` by brdf::kBrdfSyntax, of all surfaces. Throws Error (usage) when it is not, and Error
  /// (bad_input) on positions that are not finite.
  SurfaceLookup(const mesh::Scene& scene, std::string_view brdf);

  /// The middle of the scene. All that is traced is relative to it: small scenes far from the
  /// origin keep their precision.
  const Vec3& centre() const { return centre_; }
  /// And in these units: scenes of any size are traced alike.
  float scale() const { return scale_; }
  ray::Triangles triangles() const { return {positions_, indices_}; }

  /// What a ray in `direction` has hit. Nothing where it reflects nothing: the back of a surface.
  std::optional<SurfacePoint> surface_at(const ray::Hit& hit, const Vec3& direction) const;

 private:
  void add_triangles();
  void make_reflectors(std::string_view brdf);

  const mesh::Scene& scene_;
  Vec3 centre_{0.0f};
  float scale_ = 1.0f;
  std::vector<Vec3> positions_;  // relative to the centre, scaled
  std::vector<std::uint32_t> indices_;
  std::vector<std::uint32_t> primitive_of_triangle_;
  std::vector<std::uint32_t> first_triangle_;  // of each primitive
  std::vector<Reflector> reflectors_;          // of each material; last, of primitives without one
  std::vector<std::uint8_t> is_isotropic_;     // each of them
};

}  // namespace prt::reference
