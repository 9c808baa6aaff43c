#include "transfer/matrix.h"

#include <gtest/gtest.h>

#include "brdf/brdf_matrix.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "mesh/frame.h"
#include "sh/hemisphere.h"
#include "sh/quadrature.h"
#include "sh/rotation.h"
#include "transfer/hemisphere.h"
#include "transfer/matrices.h"
#include "transfer/matrix_visibility.h"
#include "transfer/scenes.h"

namespace prt::transfer {
namespace {

/// ∫ f(light, towards) cos V(light) L(light), by the set's directions and a shadow ray each.
double direct_integral(const SceneIndex& index, std::size_t vertex, const brdf::Lobe& lobe,
                       std::span<const float> light, const Vec3& towards, std::size_t count) {
  const Directions directions = make_directions(count, 7);
  Hemisphere hemisphere(index, directions);
  hemisphere.trace(vertex);
  const auto [x, y, z] = mesh::frame_at_vertex(index.scene().primitives[0].mesh, vertex);
  const auto local = [&](const Vec3& w) {
    return brdf::Direction(double{w.dot(x)}, double{w.dot(y)}, double{w.dot(z)}).normalized();
  };
  double sum = 0;
  for (const WeightedRow& ray : hemisphere.visible()) {
    const Vec3 w = directions[ray.row];
    sum +=
        double{ray.weight} * lobe.evaluate(local(w), local(towards)) *
        double{sh::evaluate_sum(static_cast<int>(std::lround(std::sqrt(light.size()))), light, w)};
  }
  return 4 * kPi / static_cast<double>(count) * sum;
}

TEST(TransferMatrix, TripleProductsMultiplyFunctions) {
  for (int band_count : {1, 3, 5}) {
    const auto n = static_cast<std::size_t>(band_count * band_count);
    const auto m = static_cast<std::size_t>((2 * band_count - 1) * (2 * band_count - 1));
    const std::vector<float> triple = triple_products(band_count);
    ASSERT_EQ(triple.size(), m * n * n);
    // Σ_k C_kij y_k = y_i y_j everywhere: the product has no other bands.
    Pcg32 random(3);
    std::vector<float> y(m);
    for (int trial = 0; trial < 20; ++trial) {
      const float z = 2 * random.uniform() - 1, phi = 6.28f * random.uniform();
      const float r = std::sqrt(1 - z * z);
      sh::evaluate(2 * band_count - 1, Vec3(r * std::cos(phi), r * std::sin(phi), z), y);
      for (std::size_t i = 0; i < n * n; ++i) {
        double sum = 0;
        for (std::size_t k = 0; k < m; ++k) sum += double{triple[k * n * n + i]} * double{y[k]};
        ASSERT_NEAR(sum, double{y[i / n]} * double{y[i % n]}, 1e-5);
      }
    }
  }
}

// The claim: moments of all products, from 2n - 1 bands of visibility, are those of the
// direct integral over the same directions.
TEST(TransferMatrix, VisibilityBandsHoldTheDirectIntegral) {
  TriangleMesh mesh = sphere(2);
  for (Vec3& p : mesh.positions) p.y += 1.3f;
  append(mesh, grid(Vec3(-3, 0, -3), Vec3(0, 0, 6), Vec3(6, 0, 0), 8));
  const mesh::Scene scene = scene_of(mesh);
  const SceneIndex index(scene);
  constexpr int kBands = 4;
  DiffuseStats stats;
  Checkpoint no_checkpoint({}, "");
  const auto rows =
      compute_visibility(index, {2 * kBands - 1, 1024, true, 5}, no_checkpoint, stats).rows;
  const auto whole =
      compute_visibility(index, {2 * kBands - 1, 1024, false, 5}, no_checkpoint, stats).rows;
  const auto triple = triple_products(kBands);
  const Directions directions = make_directions(2048, 5);
  Hemisphere hemisphere(index, directions);
  std::size_t shadowed_count = 0;
  for (std::size_t v = 0; v < index.vertex_count(); v += 17) {
    hemisphere.trace(v);
    std::vector<double> blocked(256);
    std::vector<float> y(16);
    for (const WeightedRow& ray : hemisphere.blocked()) {
      sh::evaluate(kBands, directions[ray.row], y);
      for (std::size_t i = 0; i < 256; ++i) {
        blocked[i] += 4 * kPi / 2048 * double{y[i / 16]} * double{y[i % 16]};
      }
    }
    shadowed_count += !hemisphere.blocked().empty();
    for (std::size_t i = 0; i < 256; ++i) {
      double moment = 0;
      for (std::size_t k = 0; k < 49; ++k) {
        moment += double{whole[v * 49 + k] - rows[v * 49 + k]} * double{triple[k * 256 + i]};
      }
      ASSERT_NEAR(moment, blocked[i], 2e-5) << v;
    }
  }
  EXPECT_GT(shadowed_count, 5u);
}

// Nothing shadows a convex body: T = R⁻¹ A R, so that M = A⁻¹ B R whatever the directions.
TEST(TransferMatrix, ConvexBodyIsTheBrdfTurned) {
  const TriangleMesh mesh = sphere(2);
  const char* const brdf = "ggx:0.5,0.3";
  const auto matrix = brdf::brdf_matrix(*brdf::parse_brdf(brdf), 5, 4);
  const auto rows = sh::hemisphere_functions(24);
  const auto inverse = sh::hemisphere_projection(sh::HemisphereProjection::least_squares, rows);
  const auto signal =
      bake(scene_of(mesh), brdf, {.band_count = 4, .row_count = 24, .ray_count = 256});
  ASSERT_EQ(signal.dimension(), 24 * 16);
  for (std::size_t v = 0; v < mesh.vertex_count(); v += 5) {
    const auto [x, y, z] = mesh::frame_at_vertex(mesh, v);
    const sh::Rotation rotation(
        4, Matrix4(x.x, y.x, z.x, 0, x.y, y.y, z.y, 0, x.z, y.z, z.z, 0, 0, 0, 0, 1));
    const auto light = random_light(4, v);
    std::vector<float> turned(16);
    rotation.apply(light, turned);
    for (std::size_t r = 0; r < 24; ++r) {
      double expected = 0, found = 0;
      for (std::size_t i = 0; i < 24; ++i) {
        for (std::size_t j = 0; j < 16; ++j) {
          expected += inverse[r * 24 + i] *
                      matrix.channels[0][static_cast<std::size_t>(rows[i]) * 16 + j] *
                      double{turned[j]};
        }
      }
      for (std::size_t j = 0; j < 16; ++j) {
        found += double{signal.values[(v * 24 + r) * 16 + j]} * double{light[j]};
      }
      ASSERT_NEAR(found, expected, 2e-4 * (1 + std::abs(expected))) << v << " " << r;
    }
  }
}

TEST(TransferMatrix, LambertIsDiffuseTransferInAllDirections) {
  TriangleMesh mesh = sphere(3);
  for (Vec3& p : mesh.positions) p.y += 1.05f;
  append(mesh, grid(Vec3(-3, 0, -3), Vec3(0, 0, 6), Vec3(6, 0, 0), 8));
  const mesh::Scene scene = scene_of(mesh);
  const auto matrices = bake(scene, "lambert", {.ray_count = 1024});
  const auto vectors = compute(scene, {.ray_count = 1024});
  const auto light = random_light(5, 1);
  for (std::size_t v = 0; v < mesh.vertex_count(); v += 7) {
    double expected = 0;
    for (std::size_t j = 0; j < 25; ++j) expected += double{row(vectors, v)[j]} * double{light[j]};
    const auto [x, y, z] = mesh::frame_at_vertex(mesh, v);
    for (const Vec3& towards : {z, (z + x).normalized(), (z * 0.2f - y).normalized()}) {
      ASSERT_NEAR(exit_radiance(matrices, mesh, v, light, towards), expected, 2e-3) << v;
    }
  }
}

// Sphere above a floor, glossy lobes of 5 bands, against the integral with a ray each: relative
// RMS over vertices and directions.
TEST(TransferMatrix, MatchesTheDirectIntegral) {
  TriangleMesh mesh = sphere(2);
  for (Vec3& p : mesh.positions) p.y += 1.2f;
  append(mesh, grid(Vec3(-3, 0, -3), Vec3(0, 0, 6), Vec3(6, 0, 0), 8));
  const mesh::Scene scene = scene_of(mesh);
  const SceneIndex index(scene);
  const auto error = [&](const std::string& brdf, int row_count, Kind projection) {
    const auto signal =
        bake(scene, brdf, {.row_count = row_count, .ray_count = 4096, .projection = projection});
    const auto light = random_light(5, 2);
    double difference = 0, square = 0;
    for (std::size_t v = 0; v < mesh.vertex_count(); v += 9) {
      const auto [x, y, z] = mesh::frame_at_vertex(mesh, v);
      for (const Vec3& towards : {z, (z + x).normalized(), (z * 0.7f - y).normalized(),
                                  (z - x * 0.5f + y).normalized()}) {
        const double found = exit_radiance(signal, mesh, v, light, towards);
        const double expected = direct_integral(index, v, *lobe_of(brdf), light, towards, 20000);
        difference += (found - expected) * (found - expected);
        square += expected * expected;
      }
    }
    return std::sqrt(difference / square);
  };
  EXPECT_LT(error("ggx:0.4,0.7", 25, Kind::least_squares), 0.015);
  EXPECT_LT(error("phong:10", 25, Kind::least_squares), 0.05);
  // [Sloan03] Figure 7: fewer rows do as well as all without the least squares projections.
  const double zero = error("phong:10", 25, Kind::zero_hemisphere);
  const double all_but_one = error("phong:10", 24, Kind::least_squares);
  const double sixteen = error("phong:10", 16, Kind::least_squares);
  EXPECT_LT(all_but_one, zero);
  EXPECT_LT(sixteen, zero);
}

TEST(TransferMatrix, MirroredFramesShowTheSamePicture) {
  TriangleMesh mesh = sphere(1);
  const char* const brdf = "ggx:0.3,0.8";
  for (const Vec3& n : mesh.normals) {
    const Vec3 t = n.cross(Vec3(0.3f, 0.5f, 0.7f)).normalized();
    mesh.tangents.push_back({t.x, t.y, t.z, 1});
  }
  const MatrixOptions options{.shadowed = false};
  const auto right = bake(scene_of(mesh), brdf, options);
  TriangleMesh mirrored = mesh;
  for (Vec4& tangent : mirrored.tangents) tangent.w = -1;
  const auto left = bake(scene_of(mirrored), brdf, options);
  EXPECT_NE(left.values, right.values);
  const auto light = random_light(5, 3);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3 towards = (mesh.normals[v] + Vec3(0.2f, -0.3f, 0.1f)).normalized();
    ASSERT_NEAR(exit_radiance(left, mirrored, v, light, towards),
                exit_radiance(right, mesh, v, light, towards), 1e-3);
  }
}

TEST(TransferMatrix, AlbedoIsAFactorOfItsChannel) {
  mesh::Scene scene = scene_of(sphere(1));
  const MatrixOptions options{.row_count = 9, .shadowed = false};
  const auto grey = bake(scene, "phong:5", options);
  EXPECT_EQ(grey.channel_count, 1);
  mesh::Material material;
  material.base_color = {0.5f, 0.25f, 1, 1};
  scene.materials = {material};
  scene.primitives[0].material = 0;
  const auto coloured = bake(scene, "phong:5", options);
  ASSERT_EQ(coloured.channel_count, 3);
  const std::size_t size = 9 * 25;
  for (std::size_t i = 0; i < size; ++i) {
    EXPECT_EQ(coloured.values[i], 0.5f * grey.values[i]);
    EXPECT_EQ(coloured.values[size + i], 0.25f * grey.values[i]);
    EXPECT_EQ(coloured.values[2 * size + i], grey.values[i]);
  }
}

TEST(TransferMatrix, BlocksAndThreadsDoNotShow) {
  const TriangleMesh mesh = sphere(3);
  const mesh::Scene scene = scene_of(mesh);
  DiffuseStats stats;
  const MatrixOptions options{.brdf = "phong:5", .row_count = 16, .ray_count = 64};
  set_thread_count(1);
  const auto signal = bake(scene, "phong:5", options);
  set_thread_count(0);
  MatrixTransfer transfer(scene, options, stats);
  EXPECT_EQ(transfer.header().brdf, "phong:5");
  EXPECT_EQ(transfer.header().values.size(), 0u);
  EXPECT_EQ(stats.buried_vertex_count, 0u);
  std::vector<float> part(10 * 16 * 25);
  transfer.compute(70, 10, part);
  for (std::size_t i = 0; i < part.size(); ++i) {
    ASSERT_NEAR(part[i], signal.values[70 * 16 * 25 + i], 1e-5);
  }
  EXPECT_EQ(bake(scene, "phong:5", options).values, signal.values);
}

TEST(TransferMatrix, RejectsWhatItCannotHold) {
  const mesh::Scene scene = scene_of(sphere(1));
  for (const MatrixOptions& options :
       {MatrixOptions{.band_count = 9}, MatrixOptions{.band_count = 0},
        MatrixOptions{.row_count = 23}, MatrixOptions{.row_count = 1},
        MatrixOptions{.ray_count = 0}}) {
    EXPECT_THROW(bake(scene, "lambert", options), Error);
  }
}

}  // namespace
}  // namespace prt::transfer
