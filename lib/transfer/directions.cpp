#include "transfer/directions.h"

#include <ImathBox.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "core/random.h"
#include "sh/basis.h"
#include "transfer/kernels.h"

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

struct Placed {
  Vec3 direction;
  ray::CubePlace place;
};

/// Sorts directions of one face so that beams, pairs of beams, fours … are compact: halves of
/// halves, each cut across its longest side.
void sort_compactly(std::span<Placed> set) {
  constexpr std::size_t kLanes = ray::kBeamLanes;
  if (set.size() <= kLanes) return;
  Imath::Box2f box;
  for (const Placed& d : set) box.extendBy({d.place.u, d.place.v});
  const bool along_u = box.size().x >= box.size().y;
  const std::size_t half = (set.size() / kLanes + 1) / 2 * kLanes;
  std::nth_element(set.begin(), set.begin() + static_cast<std::ptrdiff_t>(half), set.end(),
                   [&](const Placed& a, const Placed& b) {
                     const auto key = [&](const Placed& d) {
                       return along_u ? std::pair(d.place.u, d.place.v)
                                      : std::pair(d.place.v, d.place.u);
                     };
                     return key(a) < key(b);
                   });
  sort_compactly(set.first(half));
  sort_compactly(set.subspan(half));
}

}  // namespace

Directions make_directions(std::size_t count, std::uint64_t seed) {
  const Imath::M33d rotation = random_rotation(seed);
  std::vector<Placed> set(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count);
    const double r = std::sqrt(1.0 - z * z);
    double turns = static_cast<double>(i) / std::numbers::phi;
    turns -= std::floor(turns);
    const double phi = 2.0 * std::numbers::pi * turns;
    const Vec3 d((Vec3d(r * std::cos(phi), r * std::sin(phi), z) * rotation).normalized());
    set[i] = {d, ray::cube_place(d)};
  }
  std::stable_sort(set.begin(), set.end(),
                   [](const Placed& a, const Placed& b) { return a.place.face < b.place.face; });
  for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
    while (end < count && set[end].place.face == set[begin].place.face) ++end;
    sort_compactly(std::span(set).subspan(begin, end - begin));
  }
  Directions directions;
  for (const Placed& placed : set) {
    directions.x.push_back(placed.direction.x);
    directions.y.push_back(placed.direction.y);
    directions.z.push_back(placed.direction.z);
  }
  directions.beams = ray::make_beams({directions.x, directions.y, directions.z});
  return directions;
}

std::vector<float> basis_rows(int band_count, const Directions& directions) {
  const std::size_t count = sh::row_size(band_count);
  std::vector<float> rows(directions.count() * padded(count));
  for (std::size_t d = 0; d < directions.count(); ++d)
    sh::evaluate(band_count, directions[d], {&rows[d * padded(count)], count});
  return rows;
}

}  // namespace prt::transfer
