// The planes of 16 triangles through the origin and their edges, of the kernel in shadow_kernel.h.
#pragma once

#include "ray/lanes16.h"

namespace prt::ray {
namespace {

/// 16 units of rounding, 2^-24: 8 for a × e, each product of which carries the roundings of e, of
/// itself and of the sum, over three coordinates; the rest for the product with (u, v, 1).
constexpr float kSlack = 0x1p-20f;

struct Lanes3 {
  Lanes x, y, z;
};
PRT_LANES Lanes3 operator-(const Lanes3& a, const Lanes3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
PRT_LANES Lanes3 operator^(const Lanes3& a, const Lanes& sign) {
  return {a.x ^ sign, a.y ^ sign, a.z ^ sign};
}
PRT_LANES Lanes3 cross(const Lanes3& a, const Lanes3& b) {
  const Lanes minus = broadcast(-0.0f);
  return {fma(a.y, b.z, (a.z * b.y) ^ minus), fma(a.z, b.x, (a.x * b.z) ^ minus),
          fma(a.x, b.y, (a.y * b.x) ^ minus)};
}
PRT_LANES Lanes dot(const Lanes3& a, const Lanes3& b) {
  return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}
PRT_LANES Lanes absolute(const Lanes& a) {
  return a & broadcast(__builtin_bit_cast(float, 0x7fffffff));
}
PRT_LANES Lanes min3(const Lanes& a, const Lanes& b, const Lanes& c) { return min(a, min(b, c)); }
PRT_LANES Lanes max3(const Lanes& a, const Lanes& b, const Lanes& c) { return max(a, max(b, c)); }

/// A corner and its largest coordinate.
struct Corner {
  Lanes3 a;
  Lanes size;
};
PRT_LANES Corner nearer(const Corner& i, const Corner& j) {
  return {{select_le(i.size, j.size, i.a.x, j.a.x), select_le(i.size, j.size, i.a.y, j.a.y),
           select_le(i.size, j.size, i.a.z, j.a.z)},
          min(i.size, j.size)};
}

/// The beam's range of u and v, narrowed to the lanes in use.
struct Range {
  Lanes u_min, u_max, v_min, v_max;
};

PRT_LANES Lanes product(const Lanes3& plane, const Lanes& u, const Lanes& v) {
  return fma(plane.x, u, fma(plane.y, v, plane.z));
}
/// The largest product over the range; never less than that of a direction in it.
PRT_LANES Lanes largest_product(const Lanes3& plane, const Range& range) {
  const Lanes rest = max(fma(plane.y, range.v_min, plane.z), fma(plane.y, range.v_max, plane.z));
  return max(fma(plane.x, range.u_min, rest), fma(plane.x, range.u_max, rest));
}

/// Planes of up to 16 triangles, positive inside; slack is in the constant term. `height` is 0
/// where the origin lies in the plane of the triangle, which then is not hit.
struct Planes {
  Lanes3 edges[3], facing;
  Lanes height;
};

PRT_LANES Lanes3 edge_plane(const Corner& i, const Corner& j, const Lanes3& edge,
                            const Lanes& sign) {
  const Corner pivot = nearer(i, j);
  Lanes3 plane = cross(pivot.a, edge) ^ sign;
  const Lanes length = absolute(edge.x) + absolute(edge.y) + absolute(edge.z);
  plane.z = fma(pivot.size * length, broadcast(kSlack), plane.z);
  return plane;
}

PRT_LANES Planes planes_of(const Lanes3 a[3]) {
  Corner corners[3];
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    corners[i] = {a[i], max3(absolute(a[i].x), absolute(a[i].y), absolute(a[i].z))};
  }
  const Lanes3 edges[3] = {a[1] - a[0], a[2] - a[1], a[0] - a[2]};
  Planes planes;
  planes.facing = cross(edges[2], edges[0]);
  const Corner nearest = nearer(nearer(corners[0], corners[1]), corners[2]);
  const Lanes det = dot(planes.facing, nearest.a), sign = det & broadcast(-0.0f);
  planes.height = absolute(det);
  planes.facing = planes.facing ^ sign;
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    planes.edges[i] = edge_plane(corners[i], corners[(i + 1) % 3], edges[i], sign);
  }
  return planes;
}

}  // namespace
}  // namespace prt::ray
