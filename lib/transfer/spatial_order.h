// An order of points in which neighbours in the list are neighbours in space: a Morton (z-order)
// curve. Rays traced in that order share caches and packets.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"

namespace prt::transfer {

/// Point numbers along the curve through the points' bounding cube; equal cells in input order.
/// Fewer than 2^32 points, all finite.
std::vector<std::uint32_t> spatial_order(std::span<const Vec3> points);

}  // namespace prt::transfer
