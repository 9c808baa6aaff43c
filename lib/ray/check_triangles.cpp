#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "ray/engine.h"

namespace prt::ray {

void check_position(const Vec3& p, std::size_t vertex) {
  // Written so that NaN fails.
  const bool valid = std::abs(p.x) <= kMaxCoordinate && std::abs(p.y) <= kMaxCoordinate &&
                     std::abs(p.z) <= kMaxCoordinate;
  if (valid) return;
  throw_bad_input("vertex position cannot be traced",
                  {.element = fmt::format("vertex {}", vertex),
                   .found = fmt::format("({}, {}, {})", p.x, p.y, p.z),
                   .expected = fmt::format("finite coordinates up to {:g}", kMaxCoordinate)});
}

void check_indices(std::span<const std::uint32_t> indices, std::size_t vertex_count) {
  if (indices.size() % 3 != 0) {
    throw_bad_input("index count is no multiple of 3",
                    {.found = fmt::format("{}", indices.size())});
  }
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] < vertex_count) continue;
    throw_bad_input("vertex index out of range",
                    {.element = fmt::format("triangle {}", i / 3),
                     .found = fmt::format("{}", indices[i]),
                     .expected = fmt::format("below {}", vertex_count)});
  }
  if (indices.size() / 3 >= kNoHit) throw_bad_input("too many triangles");
}

void check_triangles(const Triangles& triangles) {
  for (std::size_t i = 0; i < triangles.positions.size(); ++i) {
    check_position(triangles.positions[i], i);
  }
  check_indices(triangles.indices, triangles.positions.size());
}

}  // namespace prt::ray
