// Directions, rotations and quadrature over the sphere for the tests of this folder.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "core/vec.h"
#include "sh/quadrature.h"

namespace prt::sh {

inline Vec3 random_direction(Pcg32& random) {
  const float z = 2 * random.uniform() - 1;
  const float phi = 2 * std::numbers::pi_v<float> * random.uniform();
  const float r = std::sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// A frame of random axes: a proper rotation.
inline Matrix4 random_rotation(Pcg32& random) {
  const Vec3 x = random_direction(random);
  const Vec3 y = x.cross(random_direction(random)).normalized();
  const Vec3 z = x.cross(y);
  return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, 0, 0, 0, 1};
}

inline std::vector<float> random_coefficients(std::size_t count, Pcg32& random) {
  std::vector<float> values(count);
  for (float& value : values) value = 2 * random.uniform() - 1;
  return values;
}

struct SphereNode {
  double x, y, z, weight;
};

/// A product rule, exact for polynomials in x, y, z up to `degree`.
inline std::vector<SphereNode> sphere_quadrature(int degree) {
  const GaussLegendre rule(degree / 2 + 1);
  const int azimuth_count = degree + 1;
  std::vector<SphereNode> nodes;
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    const double z = rule.nodes[k], r = std::sqrt(1 - z * z);
    for (int j = 0; j < azimuth_count; ++j) {
      const double phi = 2 * std::numbers::pi * j / azimuth_count;
      nodes.push_back({r * std::cos(phi), r * std::sin(phi), z,
                       rule.weights[k] * 2 * std::numbers::pi / azimuth_count});
    }
  }
  return nodes;
}

}  // namespace prt::sh
