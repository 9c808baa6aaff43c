// The triangle test of ray/shadow_kernel.h as a plain loop over all triangles, one ray at a time.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "ray/beams.h"
#include "ray/shapes.h"

namespace prt::ray {

class PlainShadow {
 public:
  /// Shadows at one origin. `fused`: multiply-adds round once, as the kernels do beyond baseline.
  PlainShadow(const Soup& soup, const Vec3& origin, bool fused) : soup_(soup), fused_(fused) {
    float largest = 0.0f;
    for (const Vec3& p : soup.positions) {
      largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    scale_ = std::ldexp(1.0f, -(std::ilogb(largest) + 1));
    origin_ = origin * scale_;
  }

  bool blocks(const Vec3& direction) const {
    const CubePlace place = cube_place(direction);
    for (std::size_t i = 0; i < soup_.indices.size(); i += 3) {
      Vec3 a[3];
      for (std::size_t k = 0; k < 3; ++k) {
        a[k] = in_frame(soup_.positions[soup_.indices[i + k]], place.face);
      }
      if (hits(a, place.u, place.v)) return true;
    }
    return false;
  }

 private:
  Vec3 in_frame(const Vec3& position, int face) const {
    const int m = face / 2, p = (m + 1) % 3, q = (m + 2) % 3;
    const Vec3 a = position * scale_ - origin_;
    return {a[p], a[q], face % 2 != 0 ? -a[m] : a[m]};
  }
  float fma(float a, float b, float c) const {
    if (fused_) return std::fma(a, b, c);
    const volatile float product = a * b;  // not to be fused by the compiler
    return product + c;
  }
  Vec3 cross(const Vec3& a, const Vec3& b) const {
    return {fma(a.y, b.z, -(a.z * b.y)), fma(a.z, b.x, -(a.x * b.z)), fma(a.x, b.y, -(a.y * b.x))};
  }
  float product(const Vec3& plane, float u, float v) const {
    return fma(plane.x, u, fma(plane.y, v, plane.z));
  }
  static float size(const Vec3& a) {
    return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
  }
  static const Vec3& nearer(const Vec3& a, const Vec3& b) { return size(a) <= size(b) ? a : b; }

  bool hits(const Vec3 a[3], float u, float v) const {
    const Vec3 edges[3] = {a[1] - a[0], a[2] - a[1], a[0] - a[2]};
    const Vec3 normal = cross(edges[2], edges[0]);
    const Vec3& nearest = nearer(nearer(a[0], a[1]), a[2]);
    const float det = fma(normal.x, nearest.x, fma(normal.y, nearest.y, normal.z * nearest.z));
    if (det == 0.0f) return false;
    const float sign = std::copysign(1.0f, det);
    if (product(normal * sign, u, v) <= 0.0f) return false;
    for (int i = 0; i < 3; ++i) {
      const Vec3& pivot = nearer(a[i], a[(i + 1) % 3]);
      Vec3 plane = cross(pivot, edges[i]) * sign;
      const float length = std::abs(edges[i].x) + std::abs(edges[i].y) + std::abs(edges[i].z);
      plane.z = fma(size(pivot) * length, 0x1p-20f, plane.z);
      if (product(plane, u, v) < 0.0f) return false;
    }
    const auto [x0, x1] = std::minmax({a[0].x, a[1].x, a[2].x});
    const auto [y0, y1] = std::minmax({a[0].y, a[1].y, a[2].y});
    const auto [z0, z1] = std::minmax({a[0].z, a[1].z, a[2].z});
    const float near = std::max(z0, 0.0f);
    const auto [u0, u1] = std::minmax({u * near, u * z1});
    const auto [v0, v1] = std::minmax({v * near, v * z1});
    return x0 <= u1 && u0 <= x1 && y0 <= v1 && v0 <= y1 && z1 >= 0.0f;
  }

  const Soup& soup_;
  const bool fused_;
  float scale_ = 1.0f;
  Vec3 origin_;
};

}  // namespace prt::ray
