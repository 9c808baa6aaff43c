#include "mesh/frame.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace prt::mesh {
namespace {

void expect_orthonormal(const Frame& frame, float side) {
  EXPECT_NEAR(frame.x.length(), 1, 1e-5f);
  EXPECT_NEAR(frame.z.length(), 1, 1e-5f);
  EXPECT_NEAR(frame.x.dot(frame.z), 0, 1e-5f);
  EXPECT_NEAR((frame.z.cross(frame.x) * side - frame.y).length(), 0, 1e-5f);
}

TEST(Frame, FollowsNormalAndTangent) {
  TriangleMesh mesh;
  mesh.normals = {{0, 1, 0}, {0, 1, 0}};
  mesh.tangents = {{0, 0.6f, 0.8f, 1}, {0, 0, 1, -1}};
  for (std::size_t v = 0; v < 2; ++v) {
    const Frame frame = frame_at_vertex(mesh, v);
    EXPECT_EQ(frame.z, Vec3(0, 1, 0));
    EXPECT_NEAR((frame.x - Vec3(0, 0, 1)).length(), 0, 1e-6f);
    EXPECT_NEAR((frame.y - Vec3(1, 0, 0) * (v == 0 ? 1.0f : -1.0f)).length(), 0, 1e-6f);
  }
}

TEST(Frame, ExistsWithoutAUsableTangent) {
  TriangleMesh mesh;
  mesh.normals = {{0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0.6f, 0, 0.8f}};
  EXPECT_NEAR((frame_at_vertex(mesh, 0).x - Vec3(1, 0, 0)).length(), 0, 1e-6f);
  EXPECT_NEAR((frame_at_vertex(mesh, 1).x - Vec3(0, 0, 1)).length(), 0, 1e-6f);
  EXPECT_NEAR((frame_at_vertex(mesh, 3).x - Vec3(0.8f, 0, -0.6f)).length(), 0, 1e-6f);
  Pcg32 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 n = Vec3(random.uniform() - 0.5f, random.uniform() - 0.5f, random.uniform() - 0.5f);
    mesh.normals.push_back(n.normalized());
  }
  for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
    expect_orthonormal(frame_at_vertex(mesh, v), 1);
  }
  mesh.normals = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}};
  mesh.tangents = {{0, 1, 0, -1}, {0, 0, 0, 1}, {std::nanf(""), 0, 0, 1}};
  for (std::size_t v = 0; v < 3; ++v) expect_orthonormal(frame_at_vertex(mesh, v), 1);
}

}  // namespace
}  // namespace prt::mesh
