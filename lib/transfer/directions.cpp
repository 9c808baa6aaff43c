#include "transfer/directions.h"

#include <ImathBox.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "core/random.h"

namespace prt::transfer {

namespace {

using Vec3d = Imath::V3d;

/// A uniformly random rotation: the frame of a random unit quaternion [Shoemake 1992].
Imath::M33d random_rotation(std::uint64_t seed) {
  Pcg32 random(seed);
  const double u = random.uniform(), a = 2.0 * std::numbers::pi * random.uniform(),
               b = 2.0 * std::numbers::pi * random.uniform();
  const double p = std::sqrt(1.0 - u), q = std::sqrt(u);
  const double x = p * std::sin(a), y = p * std::cos(a), z = q * std::sin(b), w = q * std::cos(b);
  return {1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
          2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
          2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y)};
}

constexpr std::size_t kGroup = 16;  // directions of a packet

/// Sorts so that runs of kGroup, 2 kGroup, 4 kGroup … are compact: halves of halves, each cut
/// across its longest side.
void sort_compactly(std::span<Vec3> set) {
  if (set.size() <= kGroup) return;
  Imath::Box3f box;
  for (const Vec3& d : set) box.extendBy(d);
  const auto axis = static_cast<int>(box.majorAxis());
  const std::size_t half = (set.size() / kGroup + 1) / 2 * kGroup;
  std::nth_element(set.begin(), set.begin() + static_cast<std::ptrdiff_t>(half), set.end(),
                   [&](const Vec3& a, const Vec3& b) {
                     return std::pair(a[axis], a[(axis + 1) % 3]) <
                            std::pair(b[axis], b[(axis + 1) % 3]);
                   });
  sort_compactly(set.first(half));
  sort_compactly(set.subspan(half));
}

}  // namespace

Directions make_directions(std::size_t count, std::uint64_t seed) {
  const Imath::M33d rotation = random_rotation(seed);
  std::vector<Vec3> set(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count);
    const double r = std::sqrt(1.0 - z * z);
    double turns = static_cast<double>(i) / std::numbers::phi;
    turns -= std::floor(turns);
    const double phi = 2.0 * std::numbers::pi * turns;
    set[i] = Vec3((Vec3d(r * std::cos(phi), r * std::sin(phi), z) * rotation).normalized());
  }
  sort_compactly(set);
  Directions directions;
  for (const Vec3& d : set) {
    directions.x.push_back(d.x);
    directions.y.push_back(d.y);
    directions.z.push_back(d.z);
  }
  return directions;
}

}  // namespace prt::transfer
