// The parts of the runtime that need no OpenGL.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/error.h"
#include "cpca/overdraw.h"
#include "runtime/cluster_chunks.h"
#include "runtime/cluster_constants.h"
#include "runtime/lighting.h"
#include "runtime/models.h"
#include "runtime/shading.h"

namespace prt::runtime {
namespace {

TEST(ClusterConstants, AreTheDotProductsWithTheLight) {
  for (const int channel_count : {1, 3}) {
    const gltf::PrecomputedTransfer transfer = random_transfer(10, 5, channel_count, 300, 8);
    const sh::Light light = test_light(5);
    ClusterConstants constants(transfer, exit_layout(1, 1));
    const std::vector<Vec4>& found = constants.evaluate(light);
    ASSERT_EQ(found.size(), 300u * 9u);
    for (int cluster = 0; cluster < 300; ++cluster)
      for (int i = 0; i < 9; ++i)
        for (int color = 0; color < 3; ++color) {
          const std::span<const float> t =
              i == 0 ? transfer.encoding.mean(cluster) : transfer.encoding.basis(cluster, i - 1);
          const int first = channel_count == 3 ? 25 * color : 0;
          double sum = 0;
          for (int k = 0; k < 25; ++k)
            sum += double{t[static_cast<std::size_t>(first + k)]} *
                   light.coefficients[static_cast<std::size_t>(color)][static_cast<std::size_t>(k)];
          EXPECT_NEAR(found[static_cast<std::size_t>(cluster * 9 + i)][color], sum, 1e-5);
        }
  }
}

TEST(ClusterConstants, OfAdaptiveTransferAreThoseThatClustersHave) {
  gltf::PrecomputedTransfer transfer = random_adaptive_transfer(10, 3, 3, 20, 4);
  const std::vector<Vec4> packed =
      ClusterConstants(transfer, exit_layout(1, 1)).evaluate(test_light(3));
  const std::vector<std::uint32_t> first = first_constants(transfer.encoding);
  const std::vector<std::uint32_t> counts = std::move(transfer.encoding.component_counts);
  transfer.encoding.component_counts = {};
  const std::vector<Vec4> padded =
      ClusterConstants(transfer, exit_layout(1, 1)).evaluate(test_light(3));
  ASSERT_EQ(packed.size(), first.back());
  for (std::size_t k = 0; k < 20; ++k) {
    ASSERT_EQ(first[k + 1] - first[k], counts[k] + 1);
    for (std::size_t i = 0; i <= counts[k]; ++i) EXPECT_EQ(packed[first[k] + i], padded[5 * k + i]);
  }
}

TEST(ClusterChunks, AreSuperclustersSplitToFitTheRegisters) {
  const auto plain = random_transfer(10, 1, 1, 10, 3);  // 4 constants a cluster
  using Numbers = std::vector<std::uint32_t>;
  EXPECT_EQ(first_clusters_of_chunks(plain, 100), Numbers({0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  const auto grouped = with_superclusters(plain, 6);
  EXPECT_EQ(first_clusters_of_chunks(grouped, 100), Numbers({0, 6}));
  EXPECT_EQ(first_clusters_of_chunks(grouped, 16), Numbers({0, 4, 6}));
  EXPECT_EQ(first_clusters_of_chunks(grouped, 15), Numbers({0, 3, 6, 9}));
  EXPECT_EQ(first_clusters_of_chunks(grouped, 1), Numbers({0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST(ClusterConstants, LightOfMoreOrFewerBandsIsCutOrPadded) {
  ClusterConstants constants(random_transfer(10, 3, 3, 4, 2), exit_layout(1, 1));
  const sh::Light light = test_light(3);
  const std::vector<Vec4> expected = constants.evaluate(light);
  EXPECT_EQ(constants.evaluate(sh::with_band_count(light, 6)), expected);
  const std::vector<Vec4> dim = constants.evaluate(sh::with_band_count(light, 1));
  EXPECT_EQ(constants.evaluate(sh::with_band_count(sh::with_band_count(light, 1), 3)), dim);
}

TEST(ClusterChunks, HoldEveryTriangleOnceForEachClusterOfItsVertices) {
  const mesh::TriangleMesh mesh = torus(20, 10);
  const gltf::PrecomputedTransfer transfer = random_transfer(mesh.vertex_count(), 1, 1, 7, 0);
  const std::vector<std::uint32_t>& cluster_of = transfer.encoding.cluster_of_point;
  const ClusterChunks chunks = make_cluster_chunks(mesh.indices, cluster_of, 7);
  using Triangle = std::array<std::uint32_t, 3>;
  std::multiset<std::pair<std::uint32_t, Triangle>> expected, found;
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const Triangle triangle = mesh.triangle(i);
    std::set<std::uint32_t> clusters;
    for (const std::uint32_t vertex : triangle) clusters.insert(cluster_of[vertex]);
    for (const std::uint32_t cluster : clusters) expected.emplace(cluster, triangle);
  }
  for (std::uint32_t cluster = 0; cluster < 7; ++cluster)
    for (std::size_t i = chunks.chunk_offsets[cluster]; i < chunks.chunk_offsets[cluster + 1];
         i += 3)
      found.emplace(cluster,
                    Triangle{chunks.indices[i], chunks.indices[i + 1], chunks.indices[i + 2]});
  EXPECT_EQ(found, expected);
  EXPECT_EQ(chunks.indices.size(), 3 * cpca::sent_triangle_count(mesh.indices, cluster_of));
}

TEST(ClusterChunks, OneClusterIsTheMeshItself) {
  const mesh::TriangleMesh mesh = sphere(6, 8);
  const std::vector<std::uint32_t> zeros(mesh.vertex_count(), 0);
  EXPECT_EQ(make_cluster_chunks(mesh.indices, zeros, 1).indices, mesh.indices);
}

TEST(Lighting, TurningOnAndOnStaysARotation) {
  Matrix4 rotation;
  for (int i = 0; i < 20000; ++i)
    rotation = turned(rotation, Vec3(0.3f, 1.0f, -0.2f).normalized(), 0.01f);
  const Matrix4 product = rotation * rotation.transposed();
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) EXPECT_NEAR(product[i][j], i == j ? 1.0f : 0.0f, 1e-6f);
  Matrix4 expected;
  expected.setAxisAngle(Vec3(0, 1, 0), 0.5f);
  const Matrix4 once = turned(Matrix4(), Vec3(0, 1, 0), 0.5f);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) EXPECT_NEAR(once[i][j], expected[i][j], 1e-6f);
}

TEST(Shading, ConvexBodyOfAlbedoOneUnderConstantLightHasThatRadiance) {
  mesh::Scene scene = scene_of({sphere(6, 8)});
  signal::TransferSignal signal = unshadowed(scene, 3, {{0, 0, 0}});
  for (float& value : signal.values) value *= 2;  // that helper's albedo is 0.5 here
  const Vec3 radiance(0.25f, 1, 4);
  const sh::Light light = sh::constant_light(3, radiance);
  for (std::size_t p = 0; p < scene.vertex_count(); ++p)
    EXPECT_LT((exit_values(signal, p, light)[0] - radiance).length(), 1e-4f);
}

TEST(ToneMap, KeepsBaseColorsAndOrderAndClampsOnlyNegatives) {
  EXPECT_EQ(tone_map(Vec3(-1, -2, -3)), Vec3(0.0f));
  // Between toe and shoulder it only subtracts the reflectance of a dielectric.
  EXPECT_LT((tone_map(Vec3(0.5f, 0.3f, 0.2f)) - Vec3(0.46f, 0.26f, 0.16f)).length(), 1e-6f);
  float last = -1;
  for (float radiance = 0; radiance < 1000; radiance = radiance * 1.1f + 0.001f) {
    const Vec3 mapped = tone_map(Vec3(radiance));
    EXPECT_GE(mapped.x, last);
    EXPECT_LE(mapped.x, 1.0f);
    last = mapped.x;
  }
  EXPECT_GT(last, 0.99f);
}

TEST(Model, RefusesTransferOfAnotherMeshOrOfRowsThatAreNoFunctions) {
  const mesh::Scene scene = scene_of({sphere(6, 8)});
  EXPECT_THROW(make_model(scene, random_transfer(5, 2, 1, 2, 1), {}), Error);
  const auto of_rows = [&](int row_count) {
    return random_transfer(scene.vertex_count(), 2, 1, 2, 1, row_count);
  };
  for (const int row_count : {1, 3, 4, 8})
    EXPECT_NO_THROW(make_model(scene, of_rows(row_count), {}));
  for (const int row_count : {2, 5, 14})
    EXPECT_THROW(make_model(scene, of_rows(row_count), {}), Error);
  signal::TransferSignal signal = unshadowed(scene, 4, {{1, 0, 0}});  // 16 numbers too
  EXPECT_THROW(make_model(scene, of_rows(4), signal), Error);
}

TEST(Model, RelativeErrorIsThatOfAKnownChange) {
  const mesh::Scene scene = scene_of({sphere(6, 8)});
  signal::TransferSignal signal = unshadowed(scene, 2, {{1, 0, 0}});
  for (float& value : signal.values) value = 1.0f;  // energy 4 a vertex
  gltf::PrecomputedTransfer transfer = full_rank(signal, 2);
  transfer.encoding.weights[0] += 0.5f;
  const std::vector<float> errors = relative_errors(make_model(scene, transfer, signal));
  ASSERT_EQ(errors.size(), scene.vertex_count());
  EXPECT_NEAR(errors[0], 0.25f, 1e-4f);
  EXPECT_NEAR(errors[1], 0.0f, 1e-4f);
}

}  // namespace
}  // namespace prt::runtime
