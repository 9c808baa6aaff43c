// Imath's vectors and matrices under short names. Imath multiplies row vectors (v * M); points are
// moved by `transform_point` below, whose matrices are named world_from_local and so on.
#pragma once

#include <ImathMatrix.h>
#include <ImathVec.h>

#include <cmath>

namespace prt {

using Vec2 = Imath::V2f;
using Vec3 = Imath::V3f;
using Vec4 = Imath::V4f;
using Matrix4 = Imath::M44f;

inline Vec3 transform_point(const Matrix4& to_from, const Vec3& p) { return p * to_from; }

inline Vec3 transform_vector(const Matrix4& to_from, const Vec3& v) {
  Vec3 result;
  to_from.multDirMatrix(v, result);
  return result;
}

template <class Vec>
bool is_finite(const Vec& v) {
  for (unsigned c = 0; c < Vec::dimensions(); ++c) {
    if (!std::isfinite(v[static_cast<int>(c)])) return false;
  }
  return true;
}

}  // namespace prt
