#include <gtest/gtest.h>

#include "transfer/scenes.h"

namespace prt::transfer {
namespace {

/// Vertices of a 24 × 24 floor grid over [-2, 2]² strictly under |x|, |z| < half.
std::size_t count_under(const TriangleMesh& floor, float half) {
  std::size_t count = 0;
  for (const Vec3& p : floor.positions) count += std::abs(p.x) < half && std::abs(p.z) < half;
  return count;
}

TriangleMesh floor_grid() { return grid({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 24); }

TEST(Buried, FloorUnderARestingBlockIsRepaired) {
  const float half = 0.6f;
  // Resting exactly, sunk, and floating by less than rounding can tell.
  for (float bottom : {0.0f, -0.1f, 1e-6f}) {
    const TriangleMesh floor = floor_grid();
    mesh::Scene scene = scene_of(floor);
    add(scene, box({-half, bottom, -half}, {half, 1.0f, half}, 2));
    DiffuseStats stats;
    const auto signal = compute_diffuse(scene, {.ray_count = 256, .bounce_count = 1}, stats);
    EXPECT_EQ(stats.primitives[0].buried_vertex_count, count_under(floor, half)) << bottom;
    EXPECT_EQ(stats.unrepaired_vertex_count,
              stats.buried_vertex_count - stats.primitives[0].buried_vertex_count);
    EXPECT_GT(count_under(floor, half), 9u);
    for (std::size_t v = 0; v < floor.vertex_count(); ++v) {
      EXPECT_GT(under_constant_light(signal, v), 0.3) << bottom << " " << v;
    }
  }
}

TEST(Buried, FloorUnderAHighTableIsDarkerButNotBuried) {
  mesh::Scene scene = scene_of(floor_grid());
  add(scene, box({-0.6f, 0.02f, -0.6f}, {0.6f, 1.0f, 0.6f}, 2));
  DiffuseStats stats;
  const auto signal = compute_diffuse(scene, {.ray_count = 256}, stats);
  EXPECT_EQ(stats.buried_vertex_count, 0u);
  EXPECT_LT(under_constant_light(signal, 12 * 25 + 12), 0.05);
}

TEST(Buried, BottomOfADeepOpenPitIsDarkButNotBuried) {
  // Four walls and a bottom that face each other, a hundred times as deep as wide.
  mesh::Scene scene;
  add(scene, grid({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, 4));
  add(scene, grid({-1, 0, -1}, {2, 0, 0}, {0, 200, 0}, 4));
  add(scene, grid({1, 0, 1}, {-2, 0, 0}, {0, 200, 0}, 4));
  add(scene, grid({-1, 0, 1}, {0, 0, -2}, {0, 200, 0}, 4));
  add(scene, grid({1, 0, -1}, {0, 0, 2}, {0, 200, 0}, 4));
  DiffuseStats stats;
  const auto signal = compute_diffuse(scene, {.ray_count = 512}, stats);
  EXPECT_EQ(stats.buried_vertex_count, 0u);
  EXPECT_NEAR(under_constant_light(signal, 12), 0.0, 0.01);
}

TEST(Buried, BodyInsideAnotherHasNothingToRepairFrom) {
  mesh::Scene scene = scene_of(sphere(3));
  add(scene, box({-0.2f, -0.2f, -0.2f}, {0.2f, 0.2f, 0.2f}, 2));
  DiffuseStats stats;
  compute_diffuse(scene, {.ray_count = 128}, stats);
  EXPECT_EQ(stats.primitives[0].buried_vertex_count, 0u);
  EXPECT_EQ(stats.primitives[1].buried_vertex_count, 54u);
  EXPECT_EQ(stats.unrepaired_vertex_count, 54u);
}

TEST(Buried, SplitVerticesGetTheSameValue) {
  // The floor cut in two along x = 0, as a seam of texture coordinates does.
  TriangleMesh floor = grid({-2, 0, 2}, {2, 0, 0}, {0, 0, -4}, 12);
  append(floor, grid({0, 0, 2}, {2, 0, 0}, {0, 0, -4}, 12));
  mesh::Scene scene = scene_of(floor);
  add(scene, box({-0.5f, 0, -0.9f}, {0.8f, 1, 0.9f}, 2));
  const auto signal = compute(scene, {.ray_count = 256, .bounce_count = 1});
  std::size_t compared = 0;
  for (std::size_t a = 0; a < 169; ++a) {
    for (std::size_t b = 169; b < 338; ++b) {
      if (floor.positions[a] != floor.positions[b]) continue;
      ++compared;
      for (std::size_t i = 0; i < 25; ++i) EXPECT_EQ(row(signal, a)[i], row(signal, b)[i]);
    }
  }
  EXPECT_EQ(compared, 13u);
}

}  // namespace
}  // namespace prt::transfer
