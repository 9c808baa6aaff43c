#include "runtime/triangle_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>

#include "runtime/models.h"

namespace prt::runtime {
namespace {

using Indices = std::vector<std::uint32_t>;

std::multiset<std::array<std::uint32_t, 3>> triangles_of(const Indices& indices) {
  std::multiset<std::array<std::uint32_t, 3>> triangles;
  for (std::size_t i = 0; i < indices.size(); i += 3)
    triangles.insert({indices[i], indices[i + 1], indices[i + 2]});
  return triangles;
}

Indices shuffled(const Indices& indices) {
  std::vector<std::size_t> order(indices.size() / 3);
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  Indices result;
  for (const std::size_t i : order)
    result.insert(result.end(), &indices[3 * i], &indices[3 * i] + 3);
  return result;
}

/// Vertices shaded for each triangle by a GPU that keeps the last `size`.
double shaded_per_triangle(const Indices& indices, std::size_t size) {
  Indices kept;
  std::size_t shaded = 0;
  for (const std::uint32_t v : indices) {
    if (std::find(kept.begin(), kept.end(), v) != kept.end()) continue;
    ++shaded;
    kept.push_back(v);
    if (kept.size() > size) kept.erase(kept.begin());
  }
  return 3.0 * static_cast<double>(shaded) / static_cast<double>(indices.size());
}

TEST(TriangleOrder, KeepsEveryTriangleAsItIs) {
  const mesh::TriangleMesh mesh = torus(40, 30);
  Indices indices = shuffled(mesh.indices);
  indices.insert(indices.end(), {7, 7, 9, 3, 3, 3, 7, 7, 9});  // degenerate, and one twice
  const Indices ordered = ordered_for_vertex_reuse(indices, mesh.vertex_count() + 5);
  EXPECT_EQ(triangles_of(ordered), triangles_of(indices));
  EXPECT_NE(ordered, indices);
  EXPECT_TRUE(ordered_for_vertex_reuse({}, 0).empty());
}

// Of an endless closed mesh, which has two triangles a vertex, 0.5 is the least; a cache of 16
// can reach about 0.6 [Sander07].
TEST(TriangleOrder, FewVerticesAreShadedTwice) {
  const mesh::TriangleMesh mesh = torus(100, 80);
  EXPECT_GT(shaded_per_triangle(shuffled(mesh.indices), 16), 2.9);
  EXPECT_GT(shaded_per_triangle(mesh.indices, 16), 0.95);
  const Indices ordered = ordered_for_vertex_reuse(shuffled(mesh.indices), mesh.vertex_count());
  EXPECT_LT(shaded_per_triangle(ordered, 16), 0.70);
  EXPECT_LT(shaded_per_triangle(ordered, 32), 0.68);
}

}  // namespace
}  // namespace prt::runtime
