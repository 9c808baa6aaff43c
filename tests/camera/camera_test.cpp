#include "camera/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace prt::camera {
namespace {

Camera oblique() {
  Camera camera;
  camera.eye = Vec3(3, 2, -4);
  camera.target = Vec3(0.5f, -0.25f, 1);
  camera.vertical_fov = 50;
  camera.aspect = 1.6f;
  return camera;
}

Vec3 project(const Matrix4& clip_from_world, const Vec3& p) {
  Vec3 ndc;
  clip_from_world.multVecMatrix(p, ndc);  // divides by w
  return ndc;
}

TEST(Camera, RayAndProjectionAreInverse) {
  const Camera camera = oblique();
  const Matrix4 clip_from_world = camera.clip_from_world(0.1f, 100.0f);
  for (float x : {-0.9f, 0.0f, 0.3f})
    for (float y : {-0.7f, 0.0f, 0.8f}) {
      const Vec3 ndc = project(clip_from_world, camera.eye + camera.ray_direction(x, y) * 5.0f);
      EXPECT_NEAR(ndc.x, x, 1e-5f);
      EXPECT_NEAR(ndc.y, y, 1e-5f);
    }
}

TEST(Camera, DepthGoesFromMinusOneAtNearToOneAtFar) {
  const Camera camera = oblique();
  const Matrix4 clip_from_world = camera.clip_from_world(0.5f, 20.0f);
  const Vec3 forward = -camera.axes().backward;
  EXPECT_NEAR(project(clip_from_world, camera.eye + forward * 0.5f).z, -1.0f, 1e-5f);
  EXPECT_NEAR(project(clip_from_world, camera.eye + forward * 20.0f).z, 1.0f, 1e-5f);
}

TEST(Camera, UpIsUpAndRightIsRight) {
  Camera camera;  // at +Z, looks to -Z
  EXPECT_GT(camera.ray_direction(0, 1).y, 0.0f);
  EXPECT_GT(camera.ray_direction(1, 0).x, 0.0f);
  EXPECT_LT(camera.ray_direction(0, 0).z, -0.99f);
}

TEST(Camera, VerticalFovIsTheWholeAngle) {
  Camera camera;
  camera.vertical_fov = 90;
  camera.aspect = 2;
  const Vec3 top = camera.ray_direction(0, 1), side = camera.ray_direction(1, 0);
  EXPECT_NEAR(top.y / -top.z, 1.0f, 1e-6f);
  EXPECT_NEAR(side.x / -side.z, 2.0f, 1e-6f);
}

TEST(Camera, LookingAlongUpStillHasOrthonormalAxes) {
  Camera camera;
  camera.eye = Vec3(0, 5, 0);
  const Camera::Axes a = camera.axes();
  EXPECT_NEAR(a.right.length(), 1.0f, 1e-6f);
  EXPECT_NEAR((a.right.cross(a.up) - a.backward).length(), 0.0f, 1e-6f);
}

TEST(Camera, FrameShowsTheWholeSphereForWideAndTallImages) {
  const Sphere bounds{Vec3(10, -4, 2), 3.0f};
  for (float aspect : {0.5f, 1.0f, 2.0f}) {
    const Camera camera = frame(bounds, 40, aspect);
    const DepthRange range = depth_range(camera, bounds);
    const Matrix4 clip_from_world = camera.clip_from_world(range.z_near, range.z_far);
    float extent = 0;
    for (int i = 0; i < 1000; ++i) {
      const float z = 1 - 2 * (i + 0.5f) / 1000, r = std::sqrt(1 - z * z), phi = 2.4f * i;
      const Vec3 p = bounds.center + Vec3(r * std::cos(phi), r * std::sin(phi), z) * bounds.radius;
      const Vec3 ndc = project(clip_from_world, p);
      for (int axis = 0; axis < 3; ++axis) EXPECT_LE(std::abs(ndc[axis]), 1.0f);
      extent = std::max({extent, std::abs(ndc.x), std::abs(ndc.y)});
    }
    EXPECT_GT(extent, 0.9f);  // and fills the image
  }
}

TEST(Camera, BoundingSphereHoldsEveryVertex) {
  mesh::Scene scene;
  scene.primitives.resize(2);
  scene.primitives[0].mesh.positions = {{0, 0, 0}, {1, 0, 0}};
  scene.primitives[1].mesh.positions = {{0, 4, 0}};
  const Sphere sphere = bounding_sphere(scene);
  for (const mesh::Primitive& primitive : scene.primitives)
    for (const Vec3& p : primitive.mesh.positions)
      EXPECT_LE((p - sphere.center).length(), sphere.radius);
  EXPECT_LT(sphere.radius, 3.0f);
  EXPECT_EQ(bounding_sphere({}).radius, 1.0f);
}

TEST(Camera, RejectsEyeAtTargetAndFlatFieldsOfView) {
  Camera camera;
  camera.eye = camera.target;
  EXPECT_THROW(check(camera), Error);
  camera = {};
  camera.vertical_fov = 180;
  EXPECT_THROW(check(camera), Error);
  EXPECT_NO_THROW(check(oblique()));
}

}  // namespace
}  // namespace prt::camera
