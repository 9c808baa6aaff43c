// What a ray has hit: the point, its normal and albedo, in the terms of the diffuse bake.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/scene.h"
#include "ray/engine.h"

namespace prt::reference {

/// A point that reflects. Directions of incoming light are those of the hemisphere around `normal`,
/// the normalised interpolation of the vertex normals, weighted by the cosine to it.
struct SurfacePoint {
  Vec3 origin;  ///< where its rays start: just off the triangle, on the side of `normal`; relative
                ///< to the scene's centre
  Vec3 normal;
  Vec3 albedo;
};

/// The triangles of a scene, numbered through in the order of its primitives. Keeps a reference to
/// the scene.
class SurfaceLookup {
 public:
  explicit SurfaceLookup(const mesh::Scene& scene);

  /// The middle of the scene. All that is traced is relative to it: small scenes far from the
  /// origin keep their precision.
  const Vec3& centre() const { return centre_; }
  ray::Triangles triangles() const { return {positions_, indices_}; }

  /// Nothing where the hit reflects nothing: the back of a surface.
  std::optional<SurfacePoint> surface_at(const ray::Hit& hit) const;

 private:
  const mesh::Scene& scene_;
  Vec3 centre_{0.0f};
  std::vector<Vec3> positions_;  // relative to the centre
  std::vector<std::uint32_t> indices_;
  std::vector<std::uint32_t> primitive_of_triangle_;
  std::vector<std::uint32_t> first_triangle_;  // of each primitive
};

}  // namespace prt::reference
