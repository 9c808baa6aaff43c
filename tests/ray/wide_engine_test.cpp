// What the engine for large scenes has beyond tests/ray/engine_test.cpp.
#include "ray/wide_engine.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "ray/shapes.h"

namespace prt::ray {
namespace {

std::vector<Hit> wide_hits(const Soup& soup, const std::vector<Ray>& rays,
                           std::size_t part_triangles) {
  const auto engine = make_wide_engine(
      std::make_shared<WideTree>(TriangleSource::of(soup.triangles()),
                                 WideTreeOptions{.folder = {}, .part_triangles = part_triangles}));
  std::vector<Hit> hits(rays.size());
  engine->closest_hit(rays, hits);
  return hits;
}

/// Triangles without area, needles and points among others.
TEST(WideEngine, AgreesWithEmbreeOnDegenerateTriangles) {
  Soup soup = random_soup(2000, 0.2f, 12);
  Pcg32 random(13);
  for (std::size_t i = 0; i < 1500; i += 3) {
    const Vec3 a = soup.positions[i], b = soup.positions[i + 1];
    soup.positions[i + 2] = random.below(2) == 0 ? b : a + (b - a) * random.uniform();
  }
  const std::vector<Ray> rays = random_rays(4000, 14);
  const std::vector<Hit> hits = wide_hits(soup, rays, 300);
  std::vector<Hit> expected(rays.size());
  make_embree_engine(soup.triangles())->closest_hit(rays, expected);
  std::size_t hit_count = 0, differing = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    hit_count += hits[i].triangle != kNoHit;
    differing += hits[i].triangle != expected[i].triangle;
  }
  EXPECT_GT(hit_count, 400u);
  EXPECT_LE(differing, 2u);
}

TEST(WideEngine, AnswersAlikeAtAnyScaleAndInPartsOfAnySize) {
  const Soup soup = random_soup(1000, 0.2f, 12);
  const std::vector<Ray> rays = random_rays(2000, 15);
  const std::vector<Hit> expected = wide_hits(soup, rays, 1000);
  for (float scale : {0x1p-50f, 1.0f, 0x1p50f}) {
    std::vector<Ray> scaled = rays;
    for (Ray& ray : scaled) ray.origin *= scale, ray.t_near *= scale, ray.t_far *= scale;
    const auto hits = wide_hits(transformed(soup, scale, Vec3(0.0f)), scaled, 64);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(hits[i].triangle, expected[i].triangle);
      ASSERT_EQ(hits[i].t, expected[i].t * scale);
      ASSERT_EQ(hits[i].u, expected[i].u);
    }
  }
}

/// More triangles in one place than a part has.
TEST(WideEngine, PartsMayShareAPlace) {
  const Soup one = random_soup(1, 0.5f, 3);
  Soup soup = one;
  for (int i = 1; i < 500; ++i) soup.indices.insert(soup.indices.end(), {0, 1, 2});
  const Vec3 middle = (one.positions[0] + one.positions[1] + one.positions[2]) / 3.0f;
  const Ray ray{middle + Vec3(0.1f, 0.2f, 3.0f), 0.0f, Vec3(-0.1f, -0.2f, -3.0f)};
  const Hit hit = wide_hits(soup, {ray}, 40)[0];
  EXPECT_EQ(hit.triangle, 0u);  // the lowest of equally near ones
  EXPECT_NEAR(hit.t, 1.0f, 1e-5f);
}

/// Leaves' boxes end at the floor's edges. Rays aimed at these are within rounding of both boxes.
TEST(WideEngine, NoRayPassesBetweenTrianglesInDifferentLeaves) {
  constexpr std::uint32_t kEdges = 65;
  Soup floor;
  for (std::uint32_t i = 0; i < kEdges; ++i) {
    const float x = 0.99f * (static_cast<float>(i) / 32.0f - 1.0f);
    floor.positions.insert(floor.positions.end(), {{x, 0.0f, -1.0f}, {x, 0.0f, 1.0f}});
    if (i + 1 == kEdges) break;
    for (std::uint32_t v : {0, 1, 2, 2, 1, 3}) floor.indices.push_back(2 * i + v);
  }
  Pcg32 random(16);
  const auto within = [&](float extent) { return extent * (2.0f * random.uniform() - 1.0f); };
  std::vector<Ray> rays;
  for (int i = 0; i < 400'000; ++i) {
    const float height = i % 2 == 0 ? 0.01f : 0.001f;
    const float edge = floor.positions[2 * (1 + random.below(kEdges - 2))].x;
    const Vec3 target(edge + within(3e-8f), 0.0f, within(0.9f));
    const Vec3 origin(edge + within(3 * height), height, target.z + within(3 * height));
    rays.push_back({origin, 0.0f, target - origin});
  }
  for (const Hit& hit : wide_hits(floor, rays, 2000)) ASSERT_NE(hit.triangle, kNoHit);
}

TEST(WideTree, ADiskWithoutRoomIsAnError) {
  const Soup soup = random_soup(10, 0.5f, 3);
  EXPECT_THROW(WideTree(TriangleSource::of(soup.triangles()), {.folder = "/nowhere"}), Error);
}

}  // namespace
}  // namespace prt::ray
