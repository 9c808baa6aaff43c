#include <gtest/gtest.h>

#include "core/error.h"
#include "core/parallel.h"
#include "transfer/clamped_cosine.h"
#include "transfer/hemisphere.h"
#include "transfer/scenes.h"

namespace prt::transfer {
namespace {

using std::numbers::pi;

// Errors of 4096 Fibonacci directions, in units of irradiance / pi, of which a direction weighs
// 4 / 4096 times its cosine. With the kink at the horizon alone 3e-5 is measured; where something
// shadows, a direction or two fall on the wrong side of its edge, and 1.3e-3 is measured.
constexpr double kSmoothError = 1e-4;
constexpr double kJumpError = 2e-3;

TEST(Shadow, ConvexObjectHasNoShadow) {
  const TriangleMesh mesh = sphere(4);
  const mesh::Scene scene = scene_of(mesh);
  DiffuseStats stats;
  const auto shadowed = compute_diffuse(scene, {}, stats);
  const auto unshadowed = compute(scene, {.shadowed = false});
  const auto sum = compute(scene, {.closed_form = false});
  EXPECT_NEAR(static_cast<double>(stats.rays_cast),
              2048.0 * static_cast<double>(mesh.vertex_count()),
              0.01 * 2048.0 * static_cast<double>(mesh.vertex_count()));
  EXPECT_EQ(shadowed.values, unshadowed.values);
  EXPECT_LT(largest_difference(sum, unshadowed), kSmoothError);
  EXPECT_GT(largest_difference(sum, unshadowed), 0.0);
  std::vector<float> lobe(25);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    clamped_cosine(5, mesh.normals[v], lobe);
    for (std::size_t i = 0; i < 25; ++i) EXPECT_NEAR(row(shadowed, v)[i], lobe[i] / pi, 1e-6);
    EXPECT_NEAR(under_constant_light(shadowed, v), 1.0, 1e-5);
  }
}

TEST(Shadow, SharpSmoothShadedBodyHasNone) {
  // Few, large faces that lean far from the normals of their vertices.
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const auto sign = [&](int bit) { return (i >> bit & 1) ? 1.0f : -1.0f; };
    mesh.positions.push_back({sign(0), sign(1), sign(2)});
    mesh.normals.push_back(mesh.positions.back().normalized());
  }
  mesh.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                  2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  DiffuseStats stats;
  const auto signal = compute_diffuse(scene_of(mesh), {}, stats);
  EXPECT_EQ(stats.buried_vertex_count, 0u);
  for (std::size_t v = 0; v < 8; ++v) EXPECT_GT(under_constant_light(signal, v), 0.8);
}

// No light comes in where floor and walls of a closed room meet, each a surface of its own.
TEST(Shadow, JointsOfARoomAreTight) {
  for (float scale : {1e-3f, 1.0f, 1e3f}) {
    const TriangleMesh room = turned_inside_out(
        box(Vec3(-1.0f, -0.7f, -1.3f) * scale, Vec3(1.1f, 0.9f, 1.7f) * scale, 5));
    DiffuseStats stats;
    const auto signal =
        compute_diffuse(scene_of(room), {.ray_count = 512, .closed_form = false}, stats);
    EXPECT_EQ(stats.buried_vertex_count, 0u);
    for (float value : signal.values) EXPECT_EQ(value, 0.0f);
  }
}

TEST(Shadow, ScaleAndTranslationChangeNothing) {
  TriangleMesh mesh = sphere(3);
  append(mesh, grid({-2, -1.5f, 2}, {4, 0, 0}, {0, 0, -4}, 8));
  for (Vec3& p : mesh.positions) {  // so that sums with the translation are exact
    for (int k = 0; k < 3; ++k) p[k] = std::round(p[k] * 1024.0f) / 1024.0f;
  }
  const auto at_origin = compute(scene_of(mesh), {.ray_count = 512});
  EXPECT_GT(largest_difference(at_origin, compute(scene_of(mesh), {.shadowed = false})), 0.1);
  TriangleMesh moved = mesh;
  for (Vec3& p : moved.positions) p += Vec3(4096.0f, -2048.0f, 1024.0f);
  EXPECT_EQ(compute(scene_of(moved), {.ray_count = 512}).values, at_origin.values);
  for (float scale : {0x1p-12f, 0x1p20f, 0x1p-100f, 0x1p100f}) {
    TriangleMesh scaled = mesh;
    for (Vec3& p : scaled.positions) p *= scale;
    EXPECT_EQ(compute(scene_of(scaled), {.ray_count = 512}).values, at_origin.values) << scale;
  }
}

// A floor point at the foot of a high wide wall loses all directions with x < 0. With the normal y
// and half a hemisphere x > 0: ∫ y = pi/2, ∫ y² = pi/3, ∫ x y = 2/3, ∫ x y² = pi/8,
// ∫ y (x² - y²) = ∫ y (3 z² - 1) = -pi/8, and odd powers of z vanish.
TEST(Shadow, FloorBeforeWallMatchesClosedForm) {
  mesh::Scene scene = scene_of(grid({0.001f, 0, 1}, {2, 0, 0}, {0, 0, -2}, 2));
  add(scene, grid({0, -1, 1e4f}, {0, 0, -2e4f}, {0, 1e4f, 0}, 1));
  const double expected[] = {0.282095 * pi / 2,
                             -0.488603 * pi / 3,
                             0.0,
                             -0.488603 * 2 / 3,
                             1.092548 * pi / 8,
                             0.0,
                             -0.315392 * pi / 8,
                             0.0,
                             -0.546274 * pi / 8};
  for (bool closed_form : {true, false}) {
    const auto signal = compute(scene, {.band_count = 3, .closed_form = closed_form});
    const std::size_t foot = 3;  // middle of the edge at the wall
    for (std::size_t i = 0; i < 9; ++i) {
      EXPECT_NEAR(row(signal, foot)[i], expected[i] / pi, kJumpError) << i;
    }
  }
}

// Form factor from a floor element to a rectangle a wide and b high that stands on the floor at
// distance c with a corner at its foot [Howell, catalogue of configuration factors, B-4]; two such
// rectangles side by side make the wall.
TEST(Shadow, FiniteWallTakesItsFormFactor) {
  const double a = 1.5, b = 2.0, c = 0.75, s = std::sqrt(b * b + c * c);
  const double factor = (std::atan(a / c) - c / s * std::atan(a / s)) / (2.0 * pi);
  mesh::Scene scene = scene_of(grid({0.75f, 0, 1}, {2, 0, 0}, {0, 0, -2}, 2));
  add(scene, grid({0, 0, 1.5f}, {0, 0, -3}, {0, 2, 0}, 1));
  for (bool closed_form : {true, false}) {
    const auto signal = compute(scene, {.closed_form = closed_form});
    EXPECT_NEAR(under_constant_light(signal, 3), 1.0 - 2.0 * factor, kJumpError);
  }
  EXPECT_GT(2.0 * factor, 0.1);
}

TEST(Shadow, BackFacesBlock) {
  mesh::Scene scene = scene_of(grid({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, 2));
  const TriangleMesh roof = grid({-100, 1, 100}, {200, 0, 0}, {0, 0, -200}, 1);
  add(scene, roof);  // its back to the floor
  EXPECT_LT(under_constant_light(compute(scene, {}), 4), 0.01);
  scene.primitives[1].mesh = turned_inside_out(roof);
  EXPECT_LT(under_constant_light(compute(scene, {}), 4), 0.01);
}

TEST(Shadow, BytesDoNotDependOnThreadsOrRuns) {
  mesh::Scene scene = scene_of(sphere(3));
  add(scene, grid({-2, -1.2f, 2}, {4, 0, 0}, {0, 0, -4}, 20), {0.9f, 0.3f, 0.2f});
  const DiffuseOptions options{.ray_count = 256, .bounce_count = 2};
  set_thread_count(1);
  const auto one = compute(scene, options);
  set_thread_count(2);
  const auto two = compute(scene, options);
  const auto again = compute(scene, options);
  set_thread_count(0);
  EXPECT_EQ(one.values, two.values);
  EXPECT_EQ(one.values, again.values);
  DiffuseOptions other_seed = options;
  other_seed.seed = 2;
  EXPECT_NE(compute(scene, other_seed).values, one.values);
}

TEST(Shadow, SignalSaysWhatItIs) {
  mesh::Scene scene = scene_of(sphere(1));
  add(scene, grid({-2, -1.2f, 2}, {4, 0, 0}, {0, 0, -4}, 2));
  DiffuseStats stats;
  const auto signal = compute_diffuse(scene, {.band_count = 4, .ray_count = 64, .seed = 9}, stats);
  EXPECT_EQ(signal.band_count, 4);
  EXPECT_EQ(signal.channel_count, 1);
  EXPECT_EQ(signal.ray_count, 64);
  EXPECT_EQ(signal.seed, 9u);
  EXPECT_EQ(signal.mesh_hash, mesh::mesh_hash(scene));
  ASSERT_EQ(signal.blocks.size(), 2u);
  EXPECT_EQ(signal.blocks[1].vertex_count, 9u);
  EXPECT_EQ(signal.values.size(), scene.vertex_count() * 16);
  ASSERT_EQ(stats.primitives.size(), 2u);
  EXPECT_EQ(stats.primitives[1].triangle_count, 8u);
}

TEST(Shadow, EmptySceneGivesAnEmptySignal) {
  EXPECT_TRUE(compute({}, {.bounce_count = 1}).values.empty());
}

TEST(Shadow, RefusesBadOptionsNormalsAndColours) {
  const auto kind_of = [](const mesh::Scene& scene, const DiffuseOptions& options) {
    try {
      compute(scene, options);
    } catch (const Error& error) {
      return error.kind();
    }
    ADD_FAILURE() << "accepted";
    return ErrorKind::failed;
  };
  mesh::Scene scene = scene_of(sphere(0));
  EXPECT_EQ(kind_of(scene, {.band_count = 0}), ErrorKind::usage);
  EXPECT_EQ(kind_of(scene, {.band_count = sh::kMaxBandCount + 1}), ErrorKind::usage);
  EXPECT_EQ(kind_of(scene, {.ray_count = 0}), ErrorKind::usage);
  EXPECT_EQ(kind_of(scene, {.bounce_count = -1}), ErrorKind::usage);
  EXPECT_EQ(kind_of(scene, {.bounce_count = 1, .shadowed = false}), ErrorKind::usage);
  scene.primitives[0].mesh.colors.assign(scene.vertex_count(), Vec4(1.0f));
  EXPECT_NO_THROW(compute(scene, {.ray_count = 16}));
  mesh::Scene bad = scene;
  bad.primitives[0].mesh.normals[2].y = NAN;
  EXPECT_EQ(kind_of(bad, {}), ErrorKind::bad_input);
  bad = scene;
  bad.primitives[0].mesh.colors[2].z = NAN;
  EXPECT_EQ(kind_of(bad, {}), ErrorKind::bad_input);
}

TEST(Hemisphere, AnswersAlikeWhateverTraces) {
  TriangleMesh mesh = sphere(3);
  for (Vec3& p : mesh.positions) p.y += 1.2f;
  append(mesh, grid(Vec3(-3, 0, -3), Vec3(0, 0, 6), Vec3(6, 0, 0), 8));
  const mesh::Scene scene = scene_of(mesh);
  const ScratchOptions in_files{.folder = std::filesystem::temp_directory_path(),
                                .in_memory_vertices = 0};
  SceneIndex small(scene), few_rays(scene), large(scene, in_files), large_few_rays(scene, in_files);
  small.build_for_shadow_rays(1000);
  large.build_for_shadow_rays(1000);
  few_rays.build_for_shadow_rays(1);
  large_few_rays.build_for_shadow_rays(1);
  EXPECT_NE(large.shadow_tree(), nullptr);
  EXPECT_EQ(few_rays.shadow_tree(), nullptr);
  EXPECT_EQ(large_few_rays.shadow_tree(), nullptr);
  const Directions directions = make_directions(1000, 3);
  Hemisphere expected(small, directions);
  for (const SceneIndex* index : {&few_rays, &large, &large_few_rays}) {
    Hemisphere other(*index, directions);
    std::size_t blocked_count = 0, hit_count = 0, difference = 0;
    for (std::size_t v = 0; v < small.vertex_count(); v += 7) {
      EXPECT_EQ(index->ray_origin(v), small.ray_origin(v));
      EXPECT_EQ(index->magnitude(v), small.magnitude(v));
      expected.trace(v);
      other.trace(v);
      blocked_count += expected.blocked().size();
      for (std::size_t i = 0, k = 0; i < expected.blocked().size(); ++i) {
        while (k < other.blocked().size() && other.blocked()[k].row < expected.blocked()[i].row) {
          ++k;
        }
        difference +=
            k == other.blocked().size() || other.blocked()[k].row != expected.blocked()[i].row;
      }
      EXPECT_NEAR(static_cast<double>(expected.visible().size()),
                  static_cast<double>(other.visible().size()), 1.0);
      for (const ray::Hit& hit : other.hits()) hit_count += hit.triangle != ray::kNoHit;
    }
    EXPECT_GT(blocked_count, 1000u);
    EXPECT_LE(difference, blocked_count / 1000);  // rays along edges
    EXPECT_GE(hit_count, blocked_count - blocked_count / 1000);
  }
}

}  // namespace
}  // namespace prt::transfer
