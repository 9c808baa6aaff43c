#include "runtime/light_inside.h"

#include <gtest/gtest.h>

#include <utility>

#include "runtime/models.h"

namespace prt::runtime {
namespace {

/// Of radius 1; without the triangles of the upper part `open`.
Model sphere_model(float open = 1.0f) {
  const mesh::TriangleMesh mesh = sphere(32, 64);
  Model model;
  model.positions = mesh.positions;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    if (mesh.positions[mesh.indices[i]].y <= open)
      model.indices.insert(model.indices.end(),
                           {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
  model.bounds = {Vec3(0.0f), 1.0f};
  return model;
}

bool warns(const Model& model, const NearLight& light) {
  testing::internal::CaptureStderr();
  warn_of_lights_inside(model, std::span(&light, 1));
  return testing::internal::GetCapturedStderr().find("inside of the model") != std::string::npos;
}

TEST(WindingNumber, IsTheShareOfDirectionsThatMeetTheModelFromBehind) {
  const Model model = sphere_model(), half = sphere_model(0.0f);
  EXPECT_NEAR(winding_number(model, Vec3(0.0f)), 1.0, 1e-6);
  EXPECT_NEAR(winding_number(model, Vec3(0.3f, -0.8f, 0.1f)), 1.0, 1e-6);
  EXPECT_NEAR(winding_number(model, Vec3(0.0f, 1.1f, 0.0f)), 0.0, 1e-6);
  EXPECT_NEAR(winding_number(half, Vec3(0.0f)), 0.5, 0.06);  // a ring of triangles more
}

TEST(LightsInside, AreWarnedOfWhereTheModelIsBlack) {
  const Model closed = sphere_model();
  Model room = closed;  // faces inward
  for (std::size_t i = 0; i < room.indices.size(); i += 3)
    std::swap(room.indices[i], room.indices[i + 1]);
  const NearLight point{Vec3(0.2f, 0.1f, 0.0f), 0.0f, Vec3(1.0f)};
  EXPECT_TRUE(warns(closed, point));
  EXPECT_FALSE(warns(room, point));
  EXPECT_FALSE(warns(closed, {Vec3(0.0f, 1.05f, 0.0f), 0.0f, Vec3(1.0f)}));
  EXPECT_FALSE(warns(sphere_model(-0.5f), point));
  EXPECT_TRUE(warns(closed, {Vec3(0.0f), 0.5f, Vec3(1.0f)}));
  EXPECT_FALSE(warns(closed, {Vec3(0.0f), 1.5f, Vec3(1.0f)}));  // all is inside of the light
}

}  // namespace
}  // namespace prt::runtime
