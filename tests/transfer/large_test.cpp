// Scenes whose arrays and trees lie in files, by a threshold of none in memory.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "core/error.h"
#include "core/parallel.h"
#include "transfer/scenes.h"

namespace prt::transfer {
namespace {

const ScratchOptions kInFiles{.folder = std::filesystem::temp_directory_path(),
                              .in_memory_vertices = 0};

double rms_difference(const signal::TransferSignal& a, const signal::TransferSignal& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    sum += std::pow(double{a.values[i]} - double{b.values[i]}, 2);
  }
  return std::sqrt(sum / static_cast<double>(a.values.size()));
}

/// The same but for rays within rounding of edges.
void expect_alike(const mesh::Scene& scene, DiffuseOptions options) {
  DiffuseStats stats, expected_stats;
  const signal::TransferSignal expected = compute_diffuse(scene, options, expected_stats);
  options.scratch = kInFiles;
  const signal::TransferSignal signal = compute_diffuse(scene, options, stats);
  ASSERT_EQ(signal.values.size(), expected.values.size());
  EXPECT_LT(rms_difference(signal, expected), 2e-5);
  EXPECT_LT(largest_difference(signal, expected), 4.0 / options.ray_count);  // one ray, two
  EXPECT_EQ(stats.buried_vertex_count, expected_stats.buried_vertex_count);
  EXPECT_EQ(stats.unrepaired_vertex_count, expected_stats.unrepaired_vertex_count);
}

/// A sphere partly sunk into a floor, some of its vertices buried.
mesh::Scene sunk_sphere(int level) {
  mesh::Scene scene;
  TriangleMesh ball = sphere(level);
  for (Vec3& p : ball.positions) p.y += 0.3f;
  add(scene, ball, Vec3(0.5f, 0.6f, 0.7f));
  add(scene, grid(Vec3(-3, 0, -3), Vec3(0, 0, 6), Vec3(6, 0, 0), 40), Vec3(0.9f));
  return scene;
}

TEST(LargeScene, HasTheTransferOfASmallOne) {
  expect_alike(sunk_sphere(6), {.ray_count = 128});  // ray by ray
  expect_alike(sunk_sphere(4), {.ray_count = 512});  // in beams
  expect_alike(sunk_sphere(3), {.band_count = 3, .shadowed = false});
}

TEST(LargeScene, HasTheBouncesOfASmallOne) {
  expect_alike(coloured_box(12), {.ray_count = 256, .bounce_count = 3});
  expect_alike(sunk_sphere(5), {.ray_count = 64, .bounce_count = 2});
}

TEST(LargeScene, GivesTheSameBytesWithAnyNumberOfThreads) {
  const mesh::Scene scene = sunk_sphere(4);
  const DiffuseOptions options{.ray_count = 32, .bounce_count = 1, .scratch = kInFiles};
  const auto expected = compute(scene, options);
  set_thread_count(1);
  EXPECT_EQ(compute(scene, options).values, expected.values);
  set_thread_count(0);
}

TEST(LargeScene, NeedsAFolderToWriteTo) {
  const DiffuseOptions options{.ray_count = 4,
                               .scratch = {.folder = "/nowhere", .in_memory_vertices = 100}};
  EXPECT_NO_THROW(compute(scene_of(sphere(1)), options));
  try {
    compute(scene_of(sphere(3)), options);
    FAIL() << "computed";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::failed);
    EXPECT_NE(std::string(error.what()).find("/nowhere"), std::string::npos);
  }
}

/// A limit on the size of files, that of the trees but not of the fields, stands for a full disk.
TEST(LargeScene, RoomForBouncesIsMissedBeforeRaysAreCast) {
  const DiffuseOptions options{.ray_count = 16, .bounce_count = 1, .scratch = kInFiles};
  const mesh::Scene scene = scene_of(sphere(4));
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{100'000, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  DiffuseStats stats;
  EXPECT_THROW(compute_diffuse(scene, options, stats), Error);
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_GT(stats.build_seconds, 0.0);
  EXPECT_EQ(stats.rays_cast, 0u);
}

}  // namespace
}  // namespace prt::transfer
