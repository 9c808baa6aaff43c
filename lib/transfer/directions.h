// The directions of the quadrature over the sphere, shared by all vertices: a spherical Fibonacci
// set [Marques et al. 2013, Spherical Fibonacci Point Sets for Illumination Integrals], turned at
// random by the seed, in an order in which neighbours in the list are neighbours on the sphere:
// beam by beam (ray/beams.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "ray/beams.h"

namespace prt::transfer {

/// `count` unit directions, each of weight 4 pi / count; planar.
struct Directions {
  std::vector<float> x, y, z;
  std::vector<ray::Beam> beams;

  std::size_t count() const { return x.size(); }
  Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

Directions make_directions(std::size_t count, std::uint64_t seed);

/// SH basis functions at all directions, a row of padded(band_count²) floats a direction, as
/// add_weighted_rows takes them (transfer/kernels.h).
std::vector<float> basis_rows(int band_count, const Directions& directions);

}  // namespace prt::transfer
