#include "transfer/spatial_order.h"

#include <ImathBox.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace prt::transfer {

namespace {

constexpr double kCells = 1 << 20;  // along each axis: 60 bits of key

/// Spreads 20 bits so that two zeros follow each.
std::uint64_t spread(std::uint64_t v) {
  v = (v | v << 32) & 0x001f00000000ffffull;
  v = (v | v << 16) & 0x001f0000ff0000ffull;
  v = (v | v << 8) & 0x100f00f00f00f00full;
  v = (v | v << 4) & 0x10c30c30c30c30c3ull;
  v = (v | v << 2) & 0x1249249249249249ull;
  return v;
}

}  // namespace

std::vector<std::uint32_t> spatial_order(std::span<const Vec3> points) {
  Imath::Box3d box;
  for (const Vec3& p : points) box.extendBy(Imath::V3d(p));
  const Imath::V3d size = points.empty() ? Imath::V3d(0.0) : box.size();
  const double extent = std::max({size.x, size.y, size.z});
  const double scale = extent > 0.0 ? kCells / extent : 0.0;
  const auto cell = [&](double offset) {
    return spread(static_cast<std::uint64_t>(std::min(offset * scale, kCells - 1)));
  };
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Imath::V3d offset = Imath::V3d(points[i]) - box.min;
    keyed[i] = {cell(offset.x) | cell(offset.y) << 1 | cell(offset.z) << 2,
                static_cast<std::uint32_t>(i)};
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::uint32_t> order(points.size());
  std::transform(keyed.begin(), keyed.end(), order.begin(), [](const auto& k) { return k.second; });
  return order;
}

}  // namespace prt::transfer
