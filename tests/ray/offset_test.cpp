#include <gtest/gtest.h>

#include <algorithm>

#include "ray/engine.h"
#include "ray/shapes.h"

namespace prt::ray {
namespace {

float magnitude(const Vec3& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

/// Shadow rays from every vertex and from points of every triangle of a sphere, `outward` or not:
/// a convex body blocks all rays that start inside and none that start outside and leave.
std::size_t wrong_rays(const Soup& soup, const Vec3& centre, bool outward) {
  const auto engine = make_embree_engine(soup.triangles());
  std::vector<Ray> rays;
  Pcg32 random(3);
  for (std::size_t i = 0; i < soup.indices.size(); i += 3) {
    const Vec3 a = soup.positions[soup.indices[i]], b = soup.positions[soup.indices[i + 1]],
               c = soup.positions[soup.indices[i + 2]];
    const Vec3 face_normal = (b - a).cross(c - a).normalized();
    const float scale = std::max({magnitude(a), magnitude(b), magnitude(c)});
    const float u = random.uniform() * 0.5f, v = random.uniform() * 0.5f;
    const Vec3 points[] = {a, (a + b) * 0.5f, a + (b - a) * u + (c - a) * v};
    for (const Vec3& p : points) {
      const Vec3 normal = (&p == points ? (p - centre).normalized() : face_normal);
      Vec3 direction = random_direction(random);
      // Leaves the sphere: above the faces around p, which lean away from the normal by a little.
      if (direction.dot(normal) < 0.0f) direction = -direction;
      if (direction.dot(normal) < 0.2f) continue;
      const Vec3 side = outward ? normal : -normal;
      rays.push_back({offset_origin(p, side, scale), 0.0f, direction});
    }
  }
  std::vector<std::uint8_t> blocked(rays.size());
  engine->occluded(rays, blocked);
  EXPECT_GT(rays.size(), 1000u);
  return static_cast<std::size_t>(
      std::count(blocked.begin(), blocked.end(), outward ? std::uint8_t{1} : std::uint8_t{0}));
}

TEST(OffsetOrigin, StaysOnItsSideAtAnyScale) {
  const Soup sphere = unit_sphere(4);
  for (float scale : {1e-6f, 1e-3f, 1.0f, 1e3f, 1e6f}) {
    const Soup soup = transformed(sphere, scale, Vec3(0.0f));
    EXPECT_EQ(wrong_rays(soup, Vec3(0.0f), true), 0u) << scale;
    EXPECT_EQ(wrong_rays(soup, Vec3(0.0f), false), 0u) << scale;
  }
}

TEST(OffsetOrigin, StaysOnItsSideFarFromTheOrigin) {
  const Soup sphere = unit_sphere(3);
  for (float scale : {1e-3f, 1.0f, 1e6f}) {
    for (float distance : {1.0f, 10.0f, 100.0f, 1000.0f}) {
      const Vec3 centre = Vec3(1.0f, -0.7f, 0.3f) * (distance * scale);
      const Soup soup = transformed(sphere, scale, centre);
      EXPECT_EQ(wrong_rays(soup, centre, true), 0u) << scale << " " << distance;
      EXPECT_EQ(wrong_rays(soup, centre, false), 0u) << scale << " " << distance;
    }
  }
}

TEST(OffsetOrigin, StepIsSmallAgainstTheScene) {
  for (float scale : {1e-3f, 1.0f, 1e6f}) {
    const Vec3 step = offset_origin(Vec3(0.0f), Vec3(0, 1, 0), scale);
    EXPECT_GT(step.y, 0.0f);
    EXPECT_LT(step.y, 1e-5f * scale);
  }
}

TEST(OffsetOrigin, MovesAlongTheNormal) {
  const Vec3 p(3.0f, -5.0f, 0.25f), n = Vec3(1.0f, 2.0f, -2.0f) / 3.0f;
  const Vec3 step = offset_origin(p, n) - p;
  EXPECT_GT(step.dot(n), 0.95f * step.length());
  EXPECT_LT(step.length(), 1e-4f);
}

}  // namespace
}  // namespace prt::ray
