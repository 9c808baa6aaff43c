// Meshes and random rays of the ray tests.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/random.h"
#include "ray/engine.h"

namespace prt::ray {

struct Soup {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> indices;

  Triangles triangles() const { return {positions, indices}; }
};

/// Uniform in a box of half width `extent`.
inline Vec3 random_point(Pcg32& random, float extent) {
  const float x = random.uniform(), y = random.uniform(), z = random.uniform();
  return (Vec3(x, y, z) * 2.0f - Vec3(1.0f)) * extent;
}

inline Vec3 random_direction(Pcg32& random) {
  const float z = 2.0f * random.uniform() - 1.0f;
  const float phi = 6.2831853f * random.uniform();
  const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
  return {r * std::cos(phi), r * std::sin(phi), z};
}

inline Soup random_soup(std::size_t triangle_count, float size, std::uint64_t seed) {
  Pcg32 random(seed);
  Soup soup;
  for (std::size_t i = 0; i < triangle_count; ++i) {
    const Vec3 centre = random_point(random, 1.0f);
    for (int k = 0; k < 3; ++k) {
      soup.indices.push_back(static_cast<std::uint32_t>(soup.positions.size()));
      soup.positions.push_back(centre + random_point(random, size));
    }
  }
  return soup;
}

/// Unit sphere, front faces outside: an octahedron, each triangle split in four `level` times.
inline Soup unit_sphere(int level) {
  Soup soup;
  soup.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  soup.indices = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  for (; level > 0; --level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [place, added] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(soup.positions.size()));
      if (added) soup.positions.push_back((soup.positions[a] + soup.positions[b]).normalized());
      return place->second;
    };
    std::vector<std::uint32_t> split;
    for (std::size_t i = 0; i < soup.indices.size(); i += 3) {
      const std::uint32_t a = soup.indices[i], b = soup.indices[i + 1], c = soup.indices[i + 2];
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (std::uint32_t k : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca}) split.push_back(k);
    }
    soup.indices = std::move(split);
  }
  return soup;
}

/// Towards all sides, of any length, some with ends.
inline std::vector<Ray> random_rays(std::size_t count, std::uint64_t seed) {
  Pcg32 random(seed);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    ray.origin = random_point(random, 1.5f);
    ray.direction = random_direction(random) * (0.1f + 3.0f * random.uniform());
    if (random.below(2) == 0) ray.t_near = random.uniform();
    if (random.below(2) == 0) ray.t_far = ray.t_near + random.uniform();
  }
  return rays;
}

/// Rays of one direction from neighbouring points.
inline std::vector<Ray> parallel_rays(std::size_t count, std::uint64_t seed) {
  Pcg32 random(seed);
  std::vector<Ray> rays(count);
  Vec3 centre(0.0f), direction(0.0f);
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 40 == 0) {
      centre = random_point(random, 1.0f);
      direction = random_direction(random);
    }
    rays[i].origin = centre + random_point(random, 0.05f);
    rays[i].direction = direction;
  }
  return rays;
}

/// scale × positions + translation.
inline Soup transformed(Soup soup, float scale, const Vec3& translation) {
  for (Vec3& p : soup.positions) p = p * scale + translation;
  return soup;
}

}  // namespace prt::ray
