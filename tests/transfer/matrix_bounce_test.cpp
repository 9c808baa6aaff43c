// Interreflection in transfer matrices.
#include <gtest/gtest.h>

#include "brdf/lobe_matrix.h"
#include "core/error.h"
#include "core/parallel.h"
#include "sh/zonal.h"
#include "transfer/hemisphere.h"
#include "transfer/matrices.h"
#include "transfer/matrix_kernels.h"
#include "transfer/reflection.h"

namespace prt::transfer {
namespace {

/// Floor and wall, each n × n squares of the unit square, that see each other.
TriangleMesh corner_mesh(std::uint32_t n) {
  TriangleMesh mesh = grid(Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 0, -1), n);
  append(mesh, grid(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), n));
  return mesh;
}

TEST(TransferMatrixBounce, LambertBouncesAreThoseOfDiffuseTransfer) {
  TriangleMesh mesh = turned_inside_out(sphere(3, true));
  append(mesh, grid(Vec3(-0.3f, -0.6f, 0.3f), Vec3(0.6f, 0, 0), Vec3(0, 0, -0.6f), 4));
  mesh::Scene scene;
  add(scene, mesh, Vec3(0.9f, 0.5f, 0.2f));
  for (int bounces : {1, 3}) {
    const auto matrices = bake(scene, "lambert", {.ray_count = 1024, .bounce_count = bounces});
    const auto vectors = compute(scene, {.ray_count = 1024, .bounce_count = bounces});
    ASSERT_EQ(matrices.channel_count, 3);
    EXPECT_EQ(matrices.bounce_count, bounces);
    const auto light = random_light(5, 2);
    double difference = 0, square = 0;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      const auto [x, y, z] = mesh::frame_at_vertex(mesh, v);
      for (int c = 0; c < 3; ++c) {
        double expected = 0;
        for (int j = 0; j < 25; ++j) {
          expected +=
              double{row(vectors, v)[c * 25 + j]} * double{light[static_cast<std::size_t>(j)]};
        }
        for (const Vec3& towards : {z, (z + x).normalized(), (z * 0.2f - y).normalized()}) {
          const double found = exit_radiance(matrices, mesh, v, light, towards, c);
          difference += (found - expected) * (found - expected);
          square += expected * expected;
        }
      }
    }
    EXPECT_LT(std::sqrt(difference / square), 0.01) << bounces;
  }
}

TEST(TransferMatrixBounce, WhiteBowlShowsConstantLightInEveryDirection) {
  const mesh::Scene scene = scene_of(turned_inside_out(sphere(2, true)));
  const auto signal =
      bake(scene, "lambert", {.band_count = 3, .ray_count = 512, .bounce_count = 30});
  std::vector<float> light(9);
  light[0] = static_cast<float>(2 * std::sqrt(kPi));
  const TriangleMesh& mesh = scene.primitives[0].mesh;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const auto [x, y, z] = mesh::frame_at_vertex(mesh, v);
    for (const Vec3& towards : {z, (z + x * 2).normalized(), (z * 0.1f - y).normalized()}) {
      EXPECT_NEAR(exit_radiance(signal, mesh, v, light, towards), 1.0, 0.01) << v;
    }
  }
}

// White furnace: in a closed room whose walls send out radiance 1 everywhere, a vertex receives
// just that, and sends out its BRDF's albedo: 1 for one of albedo 1. What the finite set of shadow
// rays leaves open of the room counts as received from outside.
TEST(TransferMatrixBounce, ClosedRoomOfConstantRadianceStaysSoForEveryBrdf) {
  const mesh::Scene scene = scene_of(turned_inside_out(box(Vec3(0), Vec3(3, 1, 2), 3)));
  const TriangleMesh& mesh = scene.primitives[0].mesh;
  const SceneIndex index(scene);
  DiffuseStats stats;
  Checkpoint no_checkpoint({}, "");
  const Visibility visibility = compute_visibility(index, {9, 512, true, 1}, no_checkpoint, stats);
  const MatrixReflection reflection(index, visibility, make_directions(256, 1),
                                    ExitBasis(sh::hemisphere_functions(24)), 5, 1);
  ExitField field(std::filesystem::temp_directory_path(), mesh.vertex_count(),
                  reflection.field_row_size());
  const ExitBasis& basis = reflection.basis();
  std::vector<float> exit(reflection.field_row_size());
  for (std::size_t f = 0; f < basis.function_count; ++f) {
    exit[f * 25] = basis.from_sh[f] * static_cast<float>(2 * std::sqrt(kPi));
  }
  std::vector<std::uint16_t> halfs(exit.size());
  float_to_half(exit.data(), halfs.data(), halfs.size());
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) field.write(v, halfs);

  const auto whole = sh::disk_lobe(5, kPi / 2);
  std::vector<std::uint32_t> vertices(mesh.vertex_count());
  for (std::uint32_t v = 0; v < vertices.size(); ++v) vertices[v] = v;
  std::vector<float> moments(vertices.size() * 25 * 32);
  reflection.add(vertices, field, moments.data(), 32);
  std::vector<double> expected(25);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    sh::turn_lobe(whole, mesh.normals[v], expected);
    for (std::size_t i = 0; i < 25; ++i) {
      const double open = double{visibility.rows[v * 81 + i]};
      ASSERT_NEAR(open, 0.0, 0.03) << v << " " << i;
      ASSERT_NEAR(double{moments[(v * 25 + i) * 32]} + open, expected[i], 1e-3) << v << " " << i;
    }
  }
  // These are the moments of an unblocked hemisphere of light 1, so what leaves is what a convex
  // body shows.
  for (const char* name :
       {"lambert", "phong:10", "ggx:0.5", "ward:0.3,0.5", "ashikhmin-shirley:8,20"}) {
    const auto convex = bake(scene, name, {.row_count = 24, .shadowed = false});
    std::vector<float> light(25);
    light[0] = static_cast<float>(2 * std::sqrt(kPi));
    for (double angle : {0.0, 0.5, 1.0}) {
      const auto [x, y, z] = mesh::frame_at_vertex(mesh, 0);
      const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
      const double albedo = brdf::directional_albedo(
          *lobe_of(name), brdf::Direction(std::sin(angle), 0, std::cos(angle)));
      EXPECT_NEAR(exit_radiance(convex, mesh, 0, light, z * c + x * s), albedo, 0.03)
          << name << " " << angle;
    }
  }
}

/// Exit radiance of a point of a scene of one primitive, by nested integrals over sets of
/// directions, with the BRDF itself.
class NestedIntegral {
 public:
  NestedIntegral(const SceneIndex& index, brdf::LobePointer lobe, std::vector<float> light)
      : index_(index), lobe_(std::move(lobe)), light_(std::move(light)) {}

  /// Of light that was reflected `bounces` times before.
  double radiance(const Vec3& origin, const Vec3& normal, const Vec3& towards, int bounces) const {
    const Directions& set = bounces == 0 ? inner_ : outer_;
    mesh::TriangleMesh point;
    point.positions = {origin}, point.normals = {normal};
    const auto [x, y, z] = mesh::frame_at_vertex(point, 0);
    const auto local = [&](const Vec3& w) {
      return brdf::Direction(double{w.dot(x)}, double{w.dot(y)}, double{w.dot(z)}).normalized();
    };
    std::vector<ray::Ray> rays;
    for (std::size_t d = 0; d < set.count(); ++d) {
      if (set[d].dot(normal) > 0) rays.push_back({.origin = origin, .direction = set[d]});
    }
    std::vector<ray::Hit> hits(rays.size());
    index_.engine().closest_hit(rays, hits);
    double sum = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Vec3& d = rays[i].direction;
      const bool blocked = hits[i].triangle != ray::kNoHit;
      if (blocked == (bounces == 0) || (blocked && hits[i].back_face)) continue;
      double incident;
      if (blocked) {
        const Vec3& n = index_.normal(index_.triangle(hits[i].triangle)[0]);
        incident =
            radiance(ray::offset_origin(origin + d * hits[i].t, n, 1.0f), n, -d, bounces - 1);
      } else {
        incident = double{sh::evaluate_sum(5, light_, d)};
      }
      sum += incident * lobe_->evaluate(local(d), local(towards)) * double{d.dot(normal)};
    }
    return 4 * kPi / static_cast<double>(set.count()) * sum;
  }

 private:
  const SceneIndex& index_;
  brdf::LobePointer lobe_;
  std::vector<float> light_;
  Directions outer_ = make_directions(1500, 3), inner_ = make_directions(1000, 4);
};

TEST(TransferMatrixBounce, MatchesNestedIntegrals) {
  const TriangleMesh mesh = corner_mesh(16);
  const mesh::Scene scene = scene_of(mesh);
  const SceneIndex index(scene);
  const auto error = [&](const char* brdf) {
    const auto direct = bake(scene, brdf, {});
    const auto bounced = bake(scene, brdf, {.bounce_count = 1});
    const auto light = random_light(5, 6);
    const NestedIntegral reference(index, lobe_of(brdf), light);
    double difference = 0, square = 0;
    for (const std::size_t v : {60u, 142u, 230u, 289u + 40u, 289u + 150u}) {
      const auto [x, y, z] = mesh::frame_at_vertex(mesh, v);
      for (const Vec3& towards :
           {z, (z + x * 0.7f).normalized(), (z + y).normalized(), (z - y).normalized()}) {
        const double found = exit_radiance(bounced, mesh, v, light, towards) -
                             exit_radiance(direct, mesh, v, light, towards);
        const double expected = reference.radiance(index.ray_origin(v), z, towards, 1);
        difference += (found - expected) * (found - expected);
        square += expected * expected;
      }
    }
    return std::sqrt(difference / square);
  };
  EXPECT_LT(error("lambert"), 0.02);
  EXPECT_LT(error("ggx:0.5"), 0.04);
  EXPECT_LT(error("phong:10"), 0.08);
  EXPECT_LT(error("ward:0.3,0.6"), 0.08);
}

// What leaves towards a detector of sensitivity w under light l is what leaves towards l under w:
// over the surface, by area and by the cosine of directions that nothing blocks.
TEST(TransferMatrixBounce, TransferBetweenTwoPatchesIsReciprocal) {
  const TriangleMesh mesh = corner_mesh(12);
  const mesh::Scene scene = scene_of(mesh);
  const SceneIndex index(scene);
  const char* const brdf = "ggx:0.5,0.7";
  const auto direct = bake(scene, brdf, {});
  const auto bounced = bake(scene, brdf, {.bounce_count = 1});
  const Directions directions = make_directions(600, 9);
  // 12 × 12 squares a patch: trapezoid weights of a vertex, by its place in the grid.
  const auto area = [](std::size_t v) {
    const std::size_t i = v % 169 % 13, j = v % 169 / 13;
    return (i % 12 == 0 ? 0.5 : 1.0) * (j % 12 == 0 ? 0.5 : 1.0) / 144;
  };
  const auto flux = [&](const signal::TransferSignal& signal, const std::vector<float>& light,
                        const std::vector<float>& detector) {
    double sum = 0;
    Hemisphere hemisphere(index, directions);
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      hemisphere.trace(v);
      for (const WeightedRow& ray : hemisphere.visible()) {
        const Vec3 w = directions[ray.row];
        sum += area(v) * double{ray.weight} * double{sh::evaluate_sum(5, detector, w)} *
               exit_radiance(signal, mesh, v, light, w);
      }
    }
    return sum;
  };
  const auto a = random_light(5, 11), b = random_light(5, 12);
  const double direct_ab = flux(direct, a, b), direct_ba = flux(direct, b, a);
  const double ab = flux(bounced, a, b) - direct_ab, ba = flux(bounced, b, a) - direct_ba;
  EXPECT_NEAR(direct_ab / direct_ba, 1.0, 0.01);
  EXPECT_NEAR(ab / ba, 1.0, 0.02);
  EXPECT_GT(std::abs(ab), 0.02 * std::abs(direct_ab));
}

TEST(TransferMatrixBounce, GlossyAndDiffuseSurfacesMix) {
  // A red Lambertian wall colours what a grey glossy floor shows of it.
  mesh::Scene scene;
  add(scene, grid(Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 0, -1), 8));
  add(scene, grid(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), 8), Vec3(0.8f, 0.1f, 0.1f));
  scene.materials[0].metallic = 1;
  scene.materials[0].roughness = 0.5f;
  scene.materials[1].specular = 0;
  const auto signal = bake(scene, "from-material", {.ray_count = 1024, .bounce_count = 1});
  std::vector<float> light(25);
  light[0] = static_cast<float>(2 * std::sqrt(kPi));
  const TriangleMesh& floor = scene.primitives[0].mesh;
  const std::size_t v = 4 * 9 + 4;
  // Towards the eye that sees the wall's mirror image, and away from it.
  const Vec3 facing = Vec3(0, 0.5f, 1).normalized(), away = Vec3(0, 0.5f, -1).normalized();
  const auto redness = [&](const Vec3& towards) {
    return exit_radiance(signal, floor, v, light, towards, 0) -
           exit_radiance(signal, floor, v, light, towards, 1);
  };
  EXPECT_GT(redness(facing), 0.15);
  EXPECT_LT(std::abs(redness(away)), 0.05);
}

TEST(TransferMatrixBounce, BytesDoNotDependOnThreads) {
  const mesh::Scene scene = scene_of(corner_mesh(12));
  const MatrixOptions options{.row_count = 16, .ray_count = 256, .bounce_count = 2};
  set_thread_count(1);
  const auto one = bake(scene, "phong:5", options);
  set_thread_count(0);
  EXPECT_EQ(bake(scene, "phong:5", options).values, one.values);
}

TEST(TransferMatrixBounce, BuriedVerticesReceiveWhatTheirNeighboursDo) {
  TriangleMesh mesh = grid(Vec3(-2, 0, 2), Vec3(4, 0, 0), Vec3(0, 0, -4), 16);
  append(mesh, box(Vec3(-0.9f, -0.1f, -0.9f), Vec3(0.9f, 1.5f, 0.9f), 4));
  const mesh::Scene scene = scene_of(mesh);
  DiffuseStats stats;
  const MatrixOptions options{.brdf = "lambert", .ray_count = 256, .bounce_count = 1};
  const auto signal = compute_matrices(scene, options, stats);
  EXPECT_GT(stats.buried_vertex_count, 0u);
  std::vector<float> light(25);
  light[0] = static_cast<float>(2 * std::sqrt(kPi));
  const std::size_t centre = 8 * 17 + 8;
  EXPECT_GT(exit_radiance(signal, mesh, centre, light, Vec3(0, 1, 0)), 0.2);
}

TEST(TransferMatrixBounce, RefusesBouncesWithoutShadowsAndFoldersThatAreNotThere) {
  const mesh::Scene scene = scene_of(sphere(1));
  EXPECT_THROW(bake(scene, "lambert", {.bounce_count = 1, .shadowed = false}), Error);
  EXPECT_THROW(bake(scene, "lambert", {.bounce_count = -1}), Error);
  EXPECT_THROW(
      bake(scene, "lambert", {.ray_count = 8, .bounce_count = 1, .scratch_folder = "/nowhere"}),
      Error);
}

}  // namespace
}  // namespace prt::transfer
