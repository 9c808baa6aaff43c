// The pinhole camera that the OpenGL runtime and the reference path tracer share, so that their
// pixels can be compared one by one.
//
// Conventions: world frame of glTF (right-handed, +Y up). Normalised device coordinates: x right,
// y up, [-1, 1]², as OpenGL has them. Image pixel (column i, row j), row 0 on top, of a w × h image
// has its centre at x = (2i + 1)/w - 1, y = 1 - (2j + 1)/h. Matrices are Imath's, for row vectors:
// clip = (p, 1) * clip_from_world; their memory is what OpenGL takes untransposed for M * v.
#pragma once

#include "core/vec.h"
#include "mesh/scene.h"

namespace prt::camera {

struct Camera {
  Vec3 eye{0.0f, 0.0f, 1.0f};
  Vec3 target{0.0f, 0.0f, 0.0f};
  Vec3 up{0.0f, 1.0f, 0.0f};   ///< need not be orthogonal to the view; parallel is repaired
  float vertical_fov = 40.0f;  ///< degrees, whole angle
  float aspect = 1.0f;         ///< width / height

  /// Orthonormal axes of the image in the world: right × up = backward (away from the target).
  struct Axes {
    Vec3 right, up, backward;
  };
  Axes axes() const;

  /// Unit direction from the eye through a point of the image.
  Vec3 ray_direction(float x_ndc, float y_ndc) const;

  /// OpenGL's clip space (z from -w to w); 0 < z_near < z_far, distances along the view axis.
  Matrix4 clip_from_world(float z_near, float z_far) const;
};

/// Throws Error (usage) when the eye is at the target, or a field is not finite or out of range.
void check(const Camera& camera);

struct Sphere {
  Vec3 center{0.0f, 0.0f, 0.0f};
  float radius = 1.0f;
};

/// Around the middle of the bounding box of all vertices; radius 1 when there are none.
Sphere bounding_sphere(const mesh::Scene& scene);

/// Looks at the sphere's centre from slightly above and right of +Z, as near as shows all of it.
Camera frame(const Sphere& bounds, float vertical_fov, float aspect);

/// Distances along the view axis that enclose the sphere, z_near > 0 also from inside it.
struct DepthRange {
  float z_near, z_far;
};
DepthRange depth_range(const Camera& camera, const Sphere& bounds);

}  // namespace prt::camera
