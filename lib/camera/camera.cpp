#include "camera/camera.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "core/error.h"

namespace prt::camera {

namespace {

constexpr float kMargin = 1.05f;                 // of the framed sphere
constexpr float kNearestShare = 1.0f / 1000.0f;  // of the far distance: keeps depth precision

float tan_half_fov(const Camera& camera) {
  return std::tan(camera.vertical_fov * std::numbers::pi_v<float> / 360.0f);
}

}  // namespace

Camera::Axes Camera::axes() const {
  const Vec3 backward = (eye - target).normalized();
  Vec3 right = up.cross(backward);
  if (right.length() < 1e-5f * up.length()) {
    // The view is along `up`: any fixed choice will do.
    const Vec3 other = std::abs(backward.z) < 0.9f ? Vec3(0, 0, -1) : Vec3(0, 1, 0);
    right = other.cross(backward);
  }
  right.normalize();
  return {right, backward.cross(right), backward};
}

Vec3 Camera::ray_direction(float x_ndc, float y_ndc) const {
  const Axes a = axes();
  const float t = tan_half_fov(*this);
  return (a.right * (x_ndc * t * aspect) + a.up * (y_ndc * t) - a.backward).normalized();
}

Matrix4 Camera::clip_from_world(float z_near, float z_far) const {
  const Axes a = axes();
  const Matrix4 view_from_world(a.right.x, a.up.x, a.backward.x, 0.0f,  //
                                a.right.y, a.up.y, a.backward.y, 0.0f,  //
                                a.right.z, a.up.z, a.backward.z, 0.0f,  //
                                -eye.dot(a.right), -eye.dot(a.up), -eye.dot(a.backward), 1.0f);
  const float f = 1.0f / tan_half_fov(*this);
  const float depth = z_near - z_far;
  const Matrix4 clip_from_view(f / aspect, 0.0f, 0.0f, 0.0f,  //
                               0.0f, f, 0.0f, 0.0f,           //
                               0.0f, 0.0f, (z_near + z_far) / depth, -1.0f, 0.0f, 0.0f,
                               2.0f * z_near * z_far / depth, 0.0f);
  return view_from_world * clip_from_view;
}

void check(const Camera& camera) {
  if (!is_finite(camera.eye) || !is_finite(camera.target) || !is_finite(camera.up) ||
      camera.eye == camera.target || camera.up.length() == 0.0f)
    throw Error(ErrorKind::usage, "the camera has no view direction",
                {.advice = "Give --eye, --target and --up finite values, eye and target apart."});
  if (!(camera.vertical_fov > 0.0f && camera.vertical_fov < 180.0f) || !(camera.aspect > 0.0f))
    throw Error(ErrorKind::usage, "the camera's field of view is out of range",
                {.expected = "an angle between 0 and 180 degrees"});
}

Sphere bounding_sphere(const mesh::Scene& scene) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Vec3 low(kInfinity), high(-kInfinity);
  for (const mesh::Primitive& primitive : scene.primitives)
    for (const Vec3& p : primitive.mesh.positions)
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], p[axis]);
        high[axis] = std::max(high[axis], p[axis]);
      }
  if (low.x > high.x) return {};
  Sphere sphere{(low + high) * 0.5f, 0.0f};
  for (const mesh::Primitive& primitive : scene.primitives)
    for (const Vec3& p : primitive.mesh.positions)
      sphere.radius = std::max(sphere.radius, (p - sphere.center).length());
  if (sphere.radius == 0.0f) sphere.radius = 1.0f;
  return sphere;
}

Camera frame(const Sphere& bounds, float vertical_fov, float aspect) {
  Camera camera;
  camera.vertical_fov = vertical_fov;
  camera.aspect = aspect;
  const float narrower = std::atan(tan_half_fov(camera) * std::min(1.0f, aspect));
  const float distance = kMargin * bounds.radius / std::sin(narrower);
  camera.target = bounds.center;
  camera.eye = bounds.center + Vec3(0.3f, 0.3f, 1.0f).normalized() * distance;
  return camera;
}

DepthRange depth_range(const Camera& camera, const Sphere& bounds) {
  const float middle = (camera.eye - bounds.center).dot(camera.axes().backward);
  const float radius = bounds.radius * kMargin;
  const float z_far = std::max(middle + radius, radius);
  return {std::max(middle - radius, z_far * kNearestShare), z_far};
}

}  // namespace prt::camera
