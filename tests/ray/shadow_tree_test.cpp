#include "ray/shadow_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/error.h"
#include "ray/plain_shadow.h"
#include "ray/shapes.h"

namespace prt::ray {
namespace {

constexpr SimdLevel kLevels[] = {SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512};

std::vector<SimdLevel> levels() {
  std::vector<SimdLevel> available;
  for (SimdLevel level : kLevels) {
    if (level <= simd_level()) available.push_back(level);
  }
  return available;
}

struct DirectionList {
  std::vector<float> x, y, z;

  void add(const Vec3& d) { x.push_back(d.x), y.push_back(d.y), z.push_back(d.z); }
  Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  std::vector<Beam> beams() const { return make_beams({x, y, z}); }
};

/// Random directions in groups of neighbours, as beams want them, and along axes and diagonals.
DirectionList random_directions(std::size_t count, std::uint64_t seed) {
  Pcg32 random(seed);
  DirectionList list;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (x != 0 || y != 0 || z != 0) list.add(Vec3(Imath::V3i(x, y, z)));
      }
    }
  }
  Vec3 centre(1, 0, 0);
  while (list.x.size() < count) {
    if (random.below(16) == 0) centre = random_direction(random);
    list.add(centre + random_point(random, 0.3f));
  }
  return list;
}

/// Which of the directions are blocked, by number.
std::vector<bool> blocked_by_tree(const ShadowTree& tree, const Vec3& origin, const Vec3& normal,
                                  const DirectionList& directions) {
  const std::vector<Beam> beams = directions.beams();
  std::vector<BeamLanes> lanes(beams.size());
  tree.trace(origin, normal, beams, lanes);
  std::vector<bool> blocked(directions.x.size());
  for (std::size_t i = 0; i < beams.size(); ++i) {
    EXPECT_EQ(lanes[i].blocked & ~lanes[i].above, 0);
    for (std::size_t lane = 0; lane < beams[i].lane_count; ++lane) {
      blocked[beams[i].first + lane] = (lanes[i].blocked >> lane & 1) != 0;
    }
  }
  return blocked;
}

/// Compares the tree with a plain loop over all triangles, ray by ray, to the last bit.
void expect_plain(const Soup& soup, const std::vector<Vec3>& origins, std::size_t direction_count,
                  std::uint64_t seed) {
  Pcg32 random(seed);
  std::size_t blocked_count = 0, count = 0;
  const DirectionList directions = random_directions(direction_count, seed);
  for (SimdLevel level : levels()) {
    const ShadowTree tree(soup.triangles(), level);
    for (const Vec3& origin : origins) {
      const Vec3 normal = random_direction(random);
      const std::vector<bool> blocked = blocked_by_tree(tree, origin, normal, directions);
      const PlainShadow plain(soup, origin, level != SimdLevel::baseline);
      for (std::size_t i = 0; i < blocked.size(); ++i) {
        const float cosine = normal.dot(directions[i]);
        if (std::abs(cosine) < 1e-6f) continue;
        const bool expected = cosine > 0.0f && plain.blocks(directions[i]);
        ASSERT_EQ(blocked[i], expected)
            << simd_level_name(level) << ", direction " << i << " of " << direction_count;
        blocked_count += expected;
        count += cosine > 0.0f;
      }
    }
  }
  EXPECT_GT(blocked_count, count / 50);
  EXPECT_LT(blocked_count, count);
}

std::vector<Vec3> random_origins(std::size_t count, float extent, std::uint64_t seed) {
  Pcg32 random(seed);
  std::vector<Vec3> origins;
  for (std::size_t i = 0; i < count; ++i) origins.push_back(random_point(random, extent));
  return origins;
}

TEST(ShadowTree, IsAPlainLoopOverRandomTriangles) {
  expect_plain(random_soup(1, 0.8f, 1), random_origins(8, 0.7f, 2), 900, 3);
  expect_plain(random_soup(16, 0.5f, 1), random_origins(8, 0.7f, 2), 900, 4);
  expect_plain(random_soup(700, 0.1f, 1), random_origins(8, 1.2f, 2), 900, 5);
  expect_plain(random_soup(3000, 0.02f, 1), random_origins(4, 1.2f, 2), 900, 6);
}

TEST(ShadowTree, IsAPlainLoopFromItsOwnVertices) {
  const Soup soup = random_soup(300, 0.3f, 4);
  std::vector<Vec3> origins(soup.positions.begin(), soup.positions.begin() + 6);
  for (int i = 6; i < 12; ++i) {
    origins.push_back(offset_origin(soup.positions[static_cast<std::size_t>(i)], {0, 0, 1}));
  }
  expect_plain(soup, origins, 700, 8);
}

TEST(ShadowTree, IsAPlainLoopAtAnyScaleAndFarOffCentre) {
  for (float scale : {1e-15f, 1e-3f, 1e3f, 5e17f}) {
    const Soup soup = transformed(random_soup(300, 0.3f, 7), scale, Vec3(0.0f));
    std::vector<Vec3> origins = random_origins(3, 1.0f, 8);
    for (Vec3& o : origins) o *= scale;
    expect_plain(soup, origins, 500, 9);
  }
  const Vec3 centre(3000.0f, -700.0f, 40.0f);
  std::vector<Vec3> origins = random_origins(4, 1.0f, 10);
  for (Vec3& o : origins) o += centre;
  expect_plain(transformed(random_soup(300, 0.3f, 7), 1.0f, centre), origins, 500, 11);
}

/// Needles, points, and triangles whose corners lie on a line, among others.
TEST(ShadowTree, IsAPlainLoopOverDegenerateTriangles) {
  Soup soup = random_soup(400, 0.3f, 12);
  Pcg32 random(13);
  for (std::size_t i = 0; i < 900; i += 3) {
    const Vec3 a = soup.positions[i], b = soup.positions[i + 1];
    Vec3& c = soup.positions[i + 2];
    switch (random.below(5)) {
      case 0:
        c = b;
        break;
      case 1:
        c = a + (b - a) * random.uniform();
        break;
      case 2:
        c = a + (b - a) * random.uniform() + random_point(random, 1e-6f);
        break;
      case 3:
        c = b + random_point(random, 1e-4f);
        break;
      default:
        soup.positions[i + 1] = c = a;
    }
  }
  expect_plain(soup, random_origins(6, 0.8f, 14), 900, 15);
}

/// Walls of a box in the planes of its coordinates, tessellated, seen from inside, from its edges
/// and from within the planes.
TEST(ShadowTree, IsAPlainLoopBetweenFlatWalls) {
  const Vec3 corner(37.0f, -1000.0f, 5.0f);
  Soup soup;
  for (int axis = 0; axis < 3; ++axis) {
    for (float side : {0.0f, 1.0f}) {
      if (axis == 1 && side > 0.0f) continue;  // open above
      for (int i = 0; i < 64; ++i) {
        const auto point = [&](int di, int dj) {
          Vec3 p(0.0f);
          p[axis] = side;
          p[(axis + 1) % 3] = static_cast<float>(i / 8 + di) / 8.0f;
          p[(axis + 2) % 3] = static_cast<float>(i % 8 + dj) / 8.0f;
          soup.indices.push_back(static_cast<std::uint32_t>(soup.positions.size()));
          soup.positions.push_back(corner + p);
        };
        point(0, 0), point(1, 0), point(1, 1), point(0, 0), point(1, 1), point(0, 1);
      }
    }
  }
  const std::vector<Vec3> origins = {corner + Vec3(0.5f),
                                     corner + Vec3(0.25f, 0.0f, 0.5f),
                                     corner + Vec3(0.25f, 0x1p-8f, 0.5f),
                                     corner + Vec3(0.0f, 0x1p-8f, 0.125f),
                                     corner + Vec3(0.0f),
                                     corner + Vec3(0.3f, 1.0f, 0.7f)};
  expect_plain(soup, origins, 900, 16);
}

TEST(ShadowTree, AgreesWithEmbreeOnASphereAndASoup) {
  Pcg32 random(17);
  for (const Soup& soup :
       {transformed(unit_sphere(4), 0.4f, Vec3(0.2f)), random_soup(2000, 0.1f, 3)}) {
    const auto engine = make_embree_engine(soup.triangles());
    const ShadowTree tree(soup.triangles());
    const DirectionList directions = random_directions(4000, 18);
    std::size_t differing = 0, count = 0;
    for (int k = 0; k < 10; ++k) {
      const Vec3 origin = random_point(random, 1.0f), normal = random_direction(random);
      const std::vector<bool> blocked = blocked_by_tree(tree, origin, normal, directions);
      std::vector<Ray> rays;
      for (std::size_t i = 0; i < blocked.size(); ++i)
        rays.push_back({origin, 0.0f, directions[i]});
      std::vector<std::uint8_t> expected(rays.size());
      engine->occluded(rays, expected);
      for (std::size_t i = 0; i < blocked.size(); ++i) {
        if (normal.dot(directions[i]) <= 1e-6f) continue;
        differing += blocked[i] != (expected[i] != 0);
        ++count;
      }
    }
    EXPECT_GT(count, 10000u);
    EXPECT_LE(differing, count / 10000);  // rays along edges
  }
}

/// Rays from inside a closed body that get out: at random, at points of edges, at vertices.
std::size_t escaped_count(const Soup& soup, const Vec3& centre, SimdLevel level) {
  const ShadowTree tree(soup.triangles(), level);
  Pcg32 random(1);
  std::size_t escaped = 0;
  for (int k = 0; k < 3; ++k) {
    const Vec3 origin = k == 0 ? centre : centre + random_point(random, 0.5f);
    DirectionList directions;
    for (std::size_t i = 0; i < soup.indices.size(); i += 3) {
      const Vec3& a = soup.positions[soup.indices[i]];
      const Vec3& b = soup.positions[soup.indices[i + 1]];
      const Vec3& c = soup.positions[soup.indices[i + 2]];
      directions.add(a - origin);
      directions.add(a + (b - a) * random.uniform() - origin);
      directions.add((a + b + c) / 3.0f - origin);
    }
    for (const Vec3& up : {Vec3(0.1f, 0.2f, 1.0f), Vec3(-0.1f, -0.2f, -1.0f)}) {
      const std::vector<bool> blocked = blocked_by_tree(tree, origin, up, directions);
      for (std::size_t i = 0; i < blocked.size(); ++i) {
        escaped += !blocked[i] && up.dot(directions[i]) > 1e-5f;
      }
    }
  }
  return escaped;
}

TEST(ShadowTree, NoRayLeavesAClosedBodyNotEvenAtVertices) {
  const Soup sphere = unit_sphere(5);
  for (SimdLevel level : levels()) {
    for (const Vec3& centre : {Vec3(0.0f), Vec3(300.0f, -20.0f, 7.0f)}) {
      EXPECT_EQ(escaped_count(transformed(sphere, 1.0f, centre), centre, level), 0u)
          << simd_level_name(level);
    }
  }
}

TEST(ShadowTree, ABeamHoldsEachDirectionOnceAndStaysOnOneFace) {
  const DirectionList directions = random_directions(1000, 19);
  std::size_t next = 0;
  for (const Beam& beam : directions.beams()) {
    EXPECT_EQ(beam.first, next);
    ASSERT_GT(beam.lane_count, 0);
    next += beam.lane_count;
    for (std::size_t lane = 0; lane < beam.lane_count; ++lane) {
      const CubePlace place = cube_place(directions[beam.first + lane]);
      EXPECT_EQ(place.face, 2 * beam.axis + beam.negative);
      EXPECT_EQ(beam.u[lane], place.u);
      EXPECT_LE(std::max(std::abs(place.u), std::abs(place.v)), 1.0f);
    }
  }
  EXPECT_EQ(next, directions.x.size());
}

TEST(ShadowTree, EmptySceneBlocksNothing) {
  const DirectionList directions = random_directions(100, 20);
  const std::vector<bool> blocked =
      blocked_by_tree(ShadowTree(Triangles{}), Vec3(0.0f), {0, 0, 1}, directions);
  EXPECT_EQ(std::count(blocked.begin(), blocked.end(), true), 0);
}

TEST(ShadowTree, RefusesWhatCannotBeTraced) {
  Soup soup{{{0, 0, 0}, {1, 0, 0}, {0, NAN, 0}}, {0, 1, 2}};
  EXPECT_THROW(ShadowTree(soup.triangles()), Error);
  soup.positions[2].y = 1.0f;
  soup.indices[1] = 3;
  EXPECT_THROW(ShadowTree(soup.triangles()), Error);
}

}  // namespace
}  // namespace prt::ray
