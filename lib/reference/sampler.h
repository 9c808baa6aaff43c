// Low-discrepancy points in the unit square for the path tracer: the first two dimensions of the
// Sobol' sequence, Owen scrambled by hashing. One pair of dimensions of a path is one pair of
// these, reordered and scrambled by a seed of its own, so that pairs are independent of each other
// and each pair is stratified over the samples of a pixel [Burley 2020, Practical Hash-based Owen
// Scrambling, JCGT 9(4)].
#pragma once

#include <cstdint>

#include "core/vec.h"

namespace prt::reference {

/// A well mixed 32-bit value of two.
std::uint32_t hash_combine(std::uint32_t a, std::uint32_t b);

/// Point `index` of the scrambled sequence of `seed`, in [0, 1)². The first 2^k points of any seed
/// are a (0, 2)-sequence's: one in every elementary interval of area 2^-k.
Vec2 sobol_point(std::uint32_t index, std::uint32_t seed);

}  // namespace prt::reference
