#include "mesh/repair.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "core/error.h"
#include "mesh/mesh_file.h"
#include "mesh/normals.h"
#include "mesh/prepare.h"
#include "mesh/tessellate.h"
#include "mesh/topology.h"

namespace prt::mesh {
namespace {

// A cube of 8 vertices, 12 triangles, edges of length 1.
TriangleMesh cube() {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.emplace_back(static_cast<float>(i & 1), static_cast<float>((i >> 1) & 1),
                                static_cast<float>(i >> 2));
  }
  for (const auto& q : {std::array{0u, 2u, 3u, 1u},
                        {4u, 5u, 7u, 6u},
                        {0u, 1u, 5u, 4u},
                        {2u, 6u, 7u, 3u},
                        {0u, 4u, 6u, 2u},
                        {1u, 3u, 7u, 5u}}) {
    mesh.indices.insert(mesh.indices.end(), {q[0], q[1], q[2], q[0], q[2], q[3]});
  }
  return mesh;
}

TEST(Repair, SmoothCubeHasNormalsAlongItsDiagonals) {
  TriangleMesh mesh = cube();
  RepairReport report;
  repair(mesh, {.crease_angle_degrees = 180.0f}, report);
  EXPECT_EQ(mesh.vertex_count(), 8u);
  EXPECT_EQ(report.computed_normal_count, 8u);
  // Angle weights make it exact although faces have one or two triangles at a corner.
  for (std::size_t i = 0; i < 8; ++i) {
    const Vec3 outwards = (mesh.positions[i] - Vec3(0.5f)).normalized();
    EXPECT_NEAR((mesh.normals[i] - outwards).length(), 0.0f, 1e-6f);
  }
}

TEST(Repair, CreaseAngleKeepsTheEdgesOfACubeHard) {
  TriangleMesh mesh = cube();
  RepairReport report;
  const auto source = repair(mesh, {.crease_angle_degrees = 30.0f}, report);
  EXPECT_EQ(mesh.vertex_count(), 24u);
  ASSERT_EQ(source.size(), 24u);
  for (std::size_t i = 0; i < 24; ++i) {
    EXPECT_EQ(mesh.positions[i], cube().positions[source[i]]);
    const Vec3& n = mesh.normals[i];
    EXPECT_FLOAT_EQ(std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}), 1.0f);
  }
}

TEST(Repair, CubeWithoutNormalsIsFaceted) {
  TriangleMesh mesh = cube();
  RepairReport report;
  repair(mesh, {}, report);
  EXPECT_EQ(mesh.vertex_count(), 24u);
  EXPECT_EQ(report.split_vertex_count, 16u);
}

// A ground of rolling hills; one vertex of its 900 is pulled out into a spike.
TEST(Repair, AFewSharpEdgesOfAScanSplitNothing) {
  TriangleMesh mesh;
  constexpr std::uint32_t kSide = 30;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    const float x = static_cast<float>(i % kSide), z = static_cast<float>(i / kSide);
    mesh.positions.emplace_back(x, std::sin(0.3f * x) + std::sin(0.2f * z), z);
    if (i % kSide + 1 == kSide || i / kSide + 1 == kSide) continue;
    mesh.indices.insert(mesh.indices.end(), {i, i + kSide, i + 1, i + 1, i + kSide, i + kSide + 1});
  }
  mesh.positions[kSide * kSide / 2 + kSide / 2].y += 10.0f;
  TriangleMesh creased = mesh;
  RepairReport report;
  repair(creased, {.crease_angle_degrees = kCreaseAngle}, report);
  EXPECT_GT(report.split_vertex_count, 0u);
  repair(mesh, {}, report);
  EXPECT_EQ(mesh.vertex_count(), kSide * kSide);
}

TEST(Repair, RecomputedNormalsWeldWhatTheOldOnesKeptApart) {
  TriangleMesh mesh = cube();
  RepairReport report;
  repair(mesh, {}, report);
  mesh.tangents.assign(24, Vec4(1, 0, 0, 1));
  repair(mesh, {.crease_angle_degrees = 180.0f, .recompute_normals = true}, report);
  EXPECT_EQ(mesh.vertex_count(), 8u);
  EXPECT_EQ(report.welded_vertex_count, 16u);
  EXPECT_TRUE(mesh.tangents.empty());
}

TEST(Repair, WeldsTriangleSoup) {
  const TriangleMesh whole = cube();
  TriangleMesh soup;
  for (const std::uint32_t index : whole.indices) {
    soup.indices.push_back(static_cast<std::uint32_t>(soup.positions.size()));
    soup.positions.push_back(whole.positions[index]);
  }
  RepairReport report;
  repair(soup, {.crease_angle_degrees = 180.0f}, report);
  EXPECT_EQ(soup.vertex_count(), 8u);
  EXPECT_EQ(report.welded_vertex_count, 28u);
  EXPECT_EQ(report.unreferenced_vertex_count, 0u);
  EXPECT_EQ(report.boundary_edge_count, 0u);
}

TEST(Repair, KeepsVerticesApartThatDifferInTexcoords) {
  TriangleMesh mesh = cube();
  mesh.positions.push_back(mesh.positions[0]);
  mesh.texcoords.assign(9, Vec2(0.0f));
  mesh.texcoords[8] = Vec2(1.0f);
  mesh.indices[0] = 8;
  RepairReport report;
  repair(mesh, {.crease_angle_degrees = 180.0f}, report);
  EXPECT_EQ(mesh.vertex_count(), 9u);
  EXPECT_EQ(report.boundary_edge_count, 0u);  // a seam is no hole
}

TEST(Repair, CountsWhatItDrops) {
  TriangleMesh mesh = cube();
  mesh.positions.emplace_back(std::nanf(""), 0.0f, 0.0f);
  mesh.positions.emplace_back(9.0f, 9.0f, 9.0f);
  mesh.indices.insert(mesh.indices.end(), {0, 1, 8, 0, 0, 1, 3, 1, 0, 2, 3, 0, 0, 3, 2});
  RepairReport report;
  repair(mesh, {}, report);
  EXPECT_EQ(report.nonfinite_vertex_count, 1u);
  EXPECT_EQ(report.nonfinite_triangle_count, 1u);
  EXPECT_EQ(report.unreferenced_vertex_count, 1u);
  EXPECT_EQ(report.degenerate_triangle_count, 1u);
  EXPECT_EQ(report.duplicate_triangle_count, 2u);  // turned round is the same, reversed is not
  EXPECT_EQ(mesh.triangle_count(), 13u);
}

TEST(Repair, DropsTrianglesWithoutAreaByRepeatedAndByCollinearCorners) {
  TriangleMesh mesh = cube();
  mesh.positions.emplace_back(0.5f, 0.0f, 0.0f);
  mesh.indices.insert(mesh.indices.end(), {0, 8, 1, 2, 2, 2});
  RepairReport report;
  repair(mesh, {}, report);
  EXPECT_EQ(report.degenerate_triangle_count, 2u);
  EXPECT_EQ(mesh.triangle_count(), 12u);
}

TEST(Repair, KeepsGoodNormalsAndReplacesBadOnes) {
  TriangleMesh mesh = cube();
  mesh.normals.assign(8, Vec3(0.0f, 0.6f, 0.8f));
  mesh.normals[0] = Vec3(0.0f);
  mesh.normals[1] = Vec3(0.0f, 0.0f, 3.0f);
  RepairReport report;
  repair(mesh, {}, report);
  EXPECT_EQ(report.computed_normal_count, 1u);
  EXPECT_EQ(mesh.normals[1], Vec3(0, 0, 1));
  EXPECT_EQ(mesh.normals[2], Vec3(0.0f, 0.6f, 0.8f));
  EXPECT_NEAR((mesh.normals[0] - Vec3(-1).normalized()).length(), 0.0f, 1e-6f);
}

TEST(Repair, MendsColoursAndTextureCoordinatesAndCountsThem) {
  const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
  TriangleMesh mesh = cube();
  mesh.texcoords.assign(8, Vec2(0.5f));
  mesh.colors.assign(8, Vec4(0.25f));
  mesh.tangents.assign(8, Vec4(1.0f, 0.0f, 0.0f, nan));
  mesh.texcoords[1] = Vec2(nan, 0.5f);
  mesh.colors[1] = Vec4(nan, 0.5f, 0.5f, 1.0f);
  mesh.texcoords[2] = Vec2(0.5f, -infinity);
  mesh.colors[3] = Vec4(2.0f, -1.0f, 0.5f, 1.0f);
  RepairReport report;
  repair(mesh, {.crease_angle_degrees = 180.0f}, report);
  EXPECT_EQ(report.mended_attribute_count, 3u);
  EXPECT_EQ(mesh.texcoords[1], Vec2(0.0f));
  EXPECT_EQ(mesh.texcoords[2], Vec2(0.0f));
  EXPECT_EQ(mesh.texcoords[3], Vec2(0.5f));
  EXPECT_EQ(mesh.colors[1], Vec4(1.0f));
  EXPECT_EQ(mesh.colors[2], Vec4(0.25f));
  EXPECT_EQ(mesh.colors[3], Vec4(1.0f, 0.0f, 0.5f, 1.0f));
  EXPECT_TRUE(mesh.tangents.empty());  // to be computed
}

TEST(Topology, CountsEdgesOfThreeFacesAndBowTies) {
  TriangleMesh fin = cube();
  fin.positions.emplace_back(0.5f, -1.0f, -1.0f);
  fin.indices.insert(fin.indices.end(), {0, 1, 8});
  EXPECT_EQ(examine_topology(fin).nonmanifold_triangle_count, 1u);

  TriangleMesh bow;
  bow.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
  bow.indices = {0, 1, 2, 0, 3, 4};
  EXPECT_EQ(examine_topology(bow).nonmanifold_vertex_count, 1u);
  EXPECT_EQ(examine_topology(bow).boundary_edge_count, 6u);
  EXPECT_EQ(examine_topology(cube()).boundary_edge_count, 0u);
}

TEST(Tangents, FollowTheTextureAndItsMirrorImage) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals.assign(3, Vec3(0, 0, 1));
  mesh.texcoords = {{0, 1}, {1, 1}, {0, 0}};  // u to the right, v down as in glTF
  mesh.indices = {0, 1, 2};
  compute_tangents(mesh);
  for (const Vec4& t : mesh.tangents) EXPECT_EQ(t, Vec4(1, 0, 0, 1));
  for (Vec2& t : mesh.texcoords) t.x = -t.x;
  compute_tangents(mesh);
  for (const Vec4& t : mesh.tangents) EXPECT_EQ(t, Vec4(-1, 0, 0, -1));
}

double area(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const auto [a, b, c] = mesh.triangle(i);
    sum += 0.5 * (mesh.positions[b] - mesh.positions[a])
                     .cross(mesh.positions[c] - mesh.positions[a])
                     .length();
  }
  return sum;
}

TEST(Tessellate, LeavesNoLongEdgeNoGapAndNoTJunction) {
  for (const float longest : {0.9f, 0.5f, 0.13f}) {
    TriangleMesh mesh = cube();
    mesh.positions[7] = {1.4f, 1.2f, 1.7f};  // edges of many lengths: all templates occur
    RepairReport report;
    repair(mesh, {.crease_angle_degrees = 10.0f}, report);
    const double before = area(mesh);
    tessellate(mesh, longest, 1'000'000);
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
      const auto t = mesh.triangle(i);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_LE((mesh.positions[t[k]] - mesh.positions[t[(k + 1) % 3]]).length(), longest);
      }
    }
    EXPECT_NEAR(area(mesh), before, 1e-5);
    // Closed although faces do not share vertices: midpoints of shared edges coincide exactly. A
    // T-junction would leave boundary edges.
    EXPECT_EQ(examine_topology(mesh).boundary_edge_count, 0u);
    EXPECT_EQ(examine_topology(mesh).nonmanifold_triangle_count, 0u);
  }
}

TEST(Tessellate, InterpolatesEveryAttribute) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
  mesh.texcoords = {{0, 0}, {1, 0}, {0, 1}};
  mesh.colors = {{0, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}};
  mesh.tangents.assign(3, Vec4(1, 0, 0, -1));
  mesh.indices = {0, 1, 2};
  tessellate(mesh, 0.3f, 1000);
  ASSERT_GT(mesh.vertex_count(), 10u);
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    EXPECT_EQ(mesh.texcoords[i], Vec2(mesh.positions[i].x, mesh.positions[i].y));
    EXPECT_EQ(mesh.colors[i], Vec4(mesh.positions[i].x, mesh.positions[i].y, 0, 1));
    EXPECT_NEAR(mesh.normals[i].length(), 1.0f, 1e-6f);
    EXPECT_EQ(mesh.tangents[i].w, -1.0f);
  }
}

TEST(Tessellate, StopsAtTheLimit) {
  TriangleMesh mesh = cube();
  EXPECT_THROW(tessellate(mesh, 0.1f, 1000), Error);
}

TEST(Tessellate, RefusesAHopelessLengthBeforeTheWork) {
  TriangleMesh mesh = cube();
  EXPECT_THROW(tessellate(mesh, 1e-5f, 50'000'000), Error);
  EXPECT_EQ(mesh.triangle_count(), 12u);
  TriangleMesh sliver;  // no area to tell, but a long edge
  sliver.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1e-9f, 0}};
  sliver.indices = {0, 1, 2};
  EXPECT_THROW(tessellate(sliver, 1e-5f, 50'000), Error);
  EXPECT_EQ(sliver.triangle_count(), 1u);
}

TEST(Data, ScenesHaveTheSizesTheirCommentsName) {
  PrepareOptions options;
  options.max_edge = 0.025f;
  Scene polygons = read_mesh_file("../data/two_polygons.obj");
  prepare(polygons, options, "two_polygons.obj");
  EXPECT_EQ(polygons.vertex_count(), 58946u);
  options.max_edge = 0.02f;
  Scene box = read_mesh_file("../data/colored_box.obj");
  prepare(box, options, "colored_box.obj");
  EXPECT_EQ(box.vertex_count(), 43918u);
  EXPECT_EQ(box.primitives.size(), 3u);
}

}  // namespace
}  // namespace prt::mesh
