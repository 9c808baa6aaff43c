#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "ray/engine.h"

namespace prt::ray {

void check_triangles(const Triangles& triangles) {
  for (std::size_t i = 0; i < triangles.positions.size(); ++i) {
    const Vec3& p = triangles.positions[i];
    // Written so that NaN fails.
    const bool valid = std::abs(p.x) <= kMaxCoordinate && std::abs(p.y) <= kMaxCoordinate &&
                       std::abs(p.z) <= kMaxCoordinate;
    if (valid) continue;
    throw_bad_input("vertex position cannot be traced",
                    {.element = fmt::format("vertex {}", i),
                     .found = fmt::format("({}, {}, {})", p.x, p.y, p.z),
                     .expected = fmt::format("finite coordinates up to {:g}", kMaxCoordinate)});
  }
  if (triangles.indices.size() % 3 != 0) {
    throw_bad_input("index count is no multiple of 3",
                    {.found = fmt::format("{}", triangles.indices.size())});
  }
  for (std::size_t i = 0; i < triangles.indices.size(); ++i) {
    if (triangles.indices[i] < triangles.positions.size()) continue;
    throw_bad_input("vertex index out of range",
                    {.element = fmt::format("triangle {}", i / 3),
                     .found = fmt::format("{}", triangles.indices[i]),
                     .expected = fmt::format("below {}", triangles.positions.size())});
  }
  if (triangles.indices.size() / 3 >= kNoHit) throw_bad_input("too many triangles");
}

}  // namespace prt::ray
