#include <algorithm>
#include <cmath>

#include "ray/engine.h"

namespace prt::ray {

namespace {

// In units of the largest coordinate M. Rounding moves p by 2^-24 M in each coordinate, the sum
// p + step by as much again; the intersector's edges and normal are off by some 2^-22 of their
// size, at most 2 M. Together under 2^-20 M; four times that keeps the step above surfaces that
// lean away from n.
constexpr float kRelativeStep = 0x1p-18f;

}  // namespace

Vec3 offset_origin(const Vec3& p, const Vec3& n, float magnitude) {
  const float largest = std::max({magnitude, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return p + n * (largest * kRelativeStep);
}

float unit_scale(float largest) {
  return largest > 0.0f ? std::ldexp(1.0f, std::clamp(-std::ilogb(largest), -126, 126)) : 1.0f;
}

}  // namespace prt::ray
