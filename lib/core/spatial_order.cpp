#include "core/spatial_order.h"

#include <ImathBox.h>

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace prt {

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

using CellOf = std::function<std::uint64_t(std::uint32_t number)>;

/// Sorts numbers by cell; those of equal cells keep their order. Many of them are dealt out first,
/// in the order of a digit of their cell; then what they share of it is known.
void sort_by_cell(std::span<std::uint32_t> numbers, const CellOf& cell_of, int digit,
                  const std::filesystem::path& folder) {
  constexpr std::size_t kManyNumbers = 1 << 20;
  constexpr int kDigitBits = 20;
  if (numbers.size() <= kManyNumbers) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed;
    for (const std::uint32_t n : numbers) keyed.emplace_back(cell_of(n), n);
    std::stable_sort(keyed.begin(), keyed.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < keyed.size(); ++i) numbers[i] = keyed[i].second;
    trim_mapped_arrays();
    return;
  }
  if (digit < 0) return;  // all in one cell
  const auto digit_of = [&](std::uint32_t n) {
    return cell_of(n) >> (digit * kDigitBits) & ((1u << kDigitBits) - 1);
  };
  std::vector<std::size_t> ends(1 << kDigitBits);  // of the numbers of each digit
  {
    MappedArray<std::uint32_t> dealt(numbers.size(), folder);
    for_each_trimmed(numbers.size(), [&](std::size_t i) { ++ends[digit_of(numbers[i])]; });
    std::exclusive_scan(ends.begin(), ends.end(), ends.begin(), std::size_t{0});
    for_each_trimmed(numbers.size(),
                     [&](std::size_t i) { dealt[ends[digit_of(numbers[i])]++] = numbers[i]; });
    for_each_trimmed(numbers.size(), [&](std::size_t i) { numbers[i] = dealt[i]; });
  }
  // As many digits together as are not many numbers, or one.
  for (std::size_t begin = 0, end = 0, d = 0; begin < numbers.size(); begin = end) {
    do end = ends[d++];
    while (d < ends.size() && ends[d] - begin <= kManyNumbers);
    sort_by_cell(numbers.subspan(begin, end - begin), cell_of, digit - 1, folder);
  }
}

}  // namespace

SpatialGrid::SpatialGrid(std::size_t count, const std::function<Vec3(std::size_t)>& point) {
  Imath::Box3d box;
  for (std::size_t i = 0; i < count; ++i) box.extendBy(Imath::V3d(point(i)));
  if (count == 0) return;
  const Imath::V3d size = box.size();
  const double extent = std::max({size.x, size.y, size.z});
  origin_ = box.min;
  if (extent > 0.0) scale_ = kCells / extent;
}

std::uint64_t SpatialGrid::cell(const Vec3& point) const {
  const Imath::V3d offset = Imath::V3d(point) - origin_;
  const auto along = [&](double distance) {
    return spread(static_cast<std::uint64_t>(std::min(distance * scale_, kCells - 1)));
  };
  return along(offset.x) | along(offset.y) << 1 | along(offset.z) << 2;
}

MappedArray<std::uint32_t> spatial_order(const SpatialGrid& grid, std::size_t count,
                                         const std::function<Vec3(std::size_t)>& point,
                                         const std::filesystem::path& folder) {
  MappedArray<std::uint32_t> order(count, folder);
  for_each_trimmed(count, [&](std::size_t i) { order[i] = static_cast<std::uint32_t>(i); });
  sort_by_cell(
      {order.data(), count}, [&](std::uint32_t i) { return grid.cell(point(i)); }, 2, folder);
  return order;
}

}  // namespace prt
