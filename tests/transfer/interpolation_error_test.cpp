#include "transfer/interpolation_error.h"

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "transfer/matrix.h"
#include "transfer/scenes.h"

namespace prt::transfer {
namespace {

/// A floor of n × n squares, 2 wide, under a box that hangs above its middle.
mesh::Scene floor_under_box(std::uint32_t n) {
  mesh::Scene scene = scene_of(grid({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, n));
  add(scene, box({-0.4f, 0.1f, -0.3f}, {0.4f, 0.6f, 0.3f}, 8));
  return scene;
}

double floor_error(std::uint32_t n) {
  const mesh::Scene scene = floor_under_box(n);
  return interpolation_errors(SceneIndex(scene)).front();
}

/// Of the floor of two triangles, from the transfer of a fine one.
double plain_error() {
  constexpr std::size_t n = 32;
  const signal::TransferSignal fine = compute(floor_under_box(n), {.ray_count = 512});
  const auto at = [&](std::size_t i, std::size_t j) { return row(fine, j * (n + 1) + i); };
  double error = 0.0, energy = 0.0;
  for (std::size_t j = 0; j <= n; ++j)
    for (std::size_t i = 0; i <= n; ++i) {
      const float u = static_cast<float>(i) / n, v = static_cast<float>(j) / n;
      const bool is_lower = u > v;  // of its two triangles
      const float *near = at(0, 0), *far = at(n, n), *other = is_lower ? at(n, 0) : at(0, n);
      const float own = std::abs(u - v), last = std::min(u, v);
      for (int k = 0; k < fine.dimension(); ++k) {
        const double there = at(i, j)[k];
        const double between = (1 - own - last) * near[k] + own * other[k] + last * far[k];
        error += (there - between) * (there - between);
        energy += there * there;
      }
    }
  return std::sqrt(error / energy);
}

TEST(InterpolationError, IsThatOfAFineMesh) {
  const double error = floor_error(1);
  EXPECT_NEAR(error / plain_error(), 1.0, 0.15);  // 256 points of an uneven error
  EXPECT_GT(error, 0.3);
}

TEST(InterpolationError, FallsAsTrianglesAreSplit) {
  const double two_triangles = floor_error(1), some = floor_error(8), many = floor_error(32);
  EXPECT_LT(some, two_triangles / 2);
  EXPECT_LT(many, some / 2);
  EXPECT_LT(many, 0.05);
}

TEST(InterpolationError, HardEdgedConvexBodiesNeedNoMoreVertices) {
  const mesh::Scene scene = scene_of(box({-1, 0, -1}, {1, 2, 1}, 1));
  EXPECT_LT(interpolation_errors(SceneIndex(scene)).front(), 1e-3);
}

TEST(InterpolationError, FewSmoothNormalsAreFarFromManyBetween) {
  const mesh::Scene coarse = scene_of(sphere(0)), fine = scene_of(sphere(4));
  EXPECT_GT(interpolation_errors(SceneIndex(coarse)).front(), 0.2);
  EXPECT_LT(interpolation_errors(SceneIndex(fine)).front(), 0.01);
}

TEST(InterpolationError, PointsThatSeeNothingDoNotCount) {
  mesh::Scene scene = scene_of(grid({-0.5f, 0.5f, 0.5f}, {1, 0, 0}, {0, 0, -1}, 4));
  add(scene, box({-1, 0, -1}, {1, 1, 1}, 2));  // around it
  EXPECT_EQ(interpolation_errors(SceneIndex(scene)).front(), 0.0);
}

TEST(InterpolationError, IsTheSameForAnyNumberOfThreads) {
  const mesh::Scene scene = floor_under_box(4);
  const SceneIndex index(scene);
  set_thread_count(1);
  const std::vector<double> one = interpolation_errors(index);
  set_thread_count(3);
  EXPECT_EQ(interpolation_errors(index), one);
  set_thread_count(0);
}

TEST(InterpolationError, OfNothingIsNothing) {
  EXPECT_TRUE(interpolation_errors(SceneIndex(mesh::Scene())).empty());
}

TEST(InterpolationError, IsToldByBothKindsOfTransferWithShadows) {
  const mesh::Scene scene = floor_under_box(1);
  DiffuseStats diffuse, matrices, unshadowed;
  compute_diffuse(scene, {.ray_count = 64}, diffuse);
  compute_matrices(scene, {.band_count = 3, .row_count = 9, .ray_count = 64}, matrices);
  compute_diffuse(scene, {.shadowed = false}, unshadowed);
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_TRUE(diffuse.primitives[i].interpolation_error);
    EXPECT_EQ(diffuse.primitives[i].interpolation_error,
              matrices.primitives[i].interpolation_error);
    EXPECT_EQ(diffuse.primitives[i].is_coarse(), i == 0);
    EXPECT_FALSE(unshadowed.primitives[i].interpolation_error);
  }
  EXPECT_FLOAT_EQ(static_cast<float>(diffuse.primitives[0].longest_edge), std::sqrt(8.0f));
}

}  // namespace
}  // namespace prt::transfer
