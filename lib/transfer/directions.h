// The directions of the quadrature over the sphere, shared by all vertices: a spherical Fibonacci
// set [Marques et al. 2013, Spherical Fibonacci Point Sets for Illumination Integrals], turned at
// random by the seed, in an order in which runs of 16 are compact on the sphere (rays go to the
// engine 16 by 16) and neighbours in the list are neighbours there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace prt::transfer {

/// `count` unit directions, each of weight 4 pi / count; planar.
struct Directions {
  std::vector<float> x, y, z;

  std::size_t count() const { return x.size(); }
  Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

Directions make_directions(std::size_t count, std::uint64_t seed);

}  // namespace prt::transfer
