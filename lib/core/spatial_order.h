// An order of points in which neighbours in the list are neighbours in space: a Morton (z-order)
// curve. Rays traced in that order share caches and packets.
#pragma once

#include <cstdint>
#include <functional>

#include "core/mapped_array.h"
#include "core/vec.h"

namespace prt {

/// The cells that the curve goes through: 2^60, of the bounding cube of points.
class SpatialGrid {
 public:
  /// Of the points point(0) … point(count - 1), all finite.
  SpatialGrid(std::size_t count, const std::function<Vec3(std::size_t)>& point);

  /// Number along the curve of the cell that holds one of the points.
  std::uint64_t cell(const Vec3& point) const;

 private:
  Imath::V3d origin_{0.0};
  double scale_ = 0.0;  ///< cells a unit of length
};

/// Numbers of the grid's points along the curve; equal cells in input order. Fewer than 2^32
/// points. With the name of a folder, the list, and another until it is done, lie in files
/// there (core/mapped_array.h).
MappedArray<std::uint32_t> spatial_order(const SpatialGrid& grid, std::size_t count,
                                         const std::function<Vec3(std::size_t)>& point,
                                         const std::filesystem::path& folder = {});

}  // namespace prt
