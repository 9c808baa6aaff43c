#include "runtime/orbit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace prt::runtime {
namespace {

camera::Camera start() { return camera::frame({Vec3(1, 2, 3), 2.0f}, 40, 1.5f); }

TEST(Orbit, StartsAtTheGivenCamera) {
  const camera::Camera camera = Orbit(start()).camera(1.5f);
  EXPECT_LT((camera.eye - start().eye).length(), 1e-4f);
  EXPECT_LT((camera.target - start().target).length(), 1e-6f);
  EXPECT_EQ(camera.vertical_fov, start().vertical_fov);
  EXPECT_EQ(camera.aspect, 1.5f);
}

TEST(Orbit, RotatingKeepsTargetAndDistanceAndStopsBeforeThePoles) {
  Orbit orbit(start());
  const float distance = (start().eye - start().target).length();
  for (const float dy : {3000.0f, -9000.0f}) {
    orbit.rotate(500, dy, 600);
    const camera::Camera camera = orbit.camera(1);
    EXPECT_NEAR((camera.eye - camera.target).length(), distance, 1e-3f);
    EXPECT_LT((camera.target - start().target).length(), 1e-6f);
    EXPECT_GT(camera.axes().up.y, 0.0f) << "upside down";
  }
}

TEST(Orbit, DraggingToTheRightTurnsTheSceneToTheRight) {
  Orbit orbit(start());
  const Vec3 right = start().axes().right;
  orbit.rotate(20, 0, 600);
  EXPECT_LT((orbit.camera(1).eye - start().eye).dot(right), 0.0f);  // the eye goes left
}

TEST(Orbit, PanningMovesTheTargetWithTheMouse) {
  Orbit orbit(start());
  constexpr float kHeight = 600;
  orbit.pan(30, -45, kHeight);
  const camera::Camera camera = orbit.camera(1);
  Vec3 ndc;
  camera.clip_from_world(0.1f, 100).multVecMatrix(start().target, ndc);
  EXPECT_NEAR(ndc.x * kHeight / 2, 30, 0.01f);
  EXPECT_NEAR(ndc.y * kHeight / 2, 45, 0.01f);
}

TEST(Orbit, ZoomingInAndOutAgainEndsWhereItBegan) {
  Orbit orbit(start());
  orbit.zoom(3);
  const float near_distance = (orbit.camera(1).eye - start().target).length();
  EXPECT_LT(near_distance, 0.8f * (start().eye - start().target).length());
  orbit.zoom(-3);
  EXPECT_LT((orbit.camera(1).eye - start().eye).length(), 1e-3f);
}

}  // namespace
}  // namespace prt::runtime
