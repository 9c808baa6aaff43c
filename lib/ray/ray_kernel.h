// One ray against a tree of triangles, 16 boxes or 16 triangles at a time. Compiled once for each
// instruction set.
//
// A ray has its own frame, as a beam has (shadow_kernel.h): z along its largest coordinate, x and y
// sheared so that the ray is the z axis. A triangle is hit where the origin of the plane x, y lies
// inside of it [Woop, Benthin, Wald 2013, Watertight Ray/Triangle Intersection]:
//
//   U = x1 y2 - y1 x2 and cyclically;  hit when U, V, W are all >= 0 or all <= 0, U + V + W != 0.
//
// A corner's x and y depend on the corner and the ray alone, and the products are rounded each for
// itself (no fused multiply-add), so that an edge has opposite signs in the two triangles that
// share it, whatever is rounded: no ray passes between them. The boxes allow for the roundings of x
// and y by an absolute margin, and for those of their own test by a relative one of the ray's
// parameter.
#pragma once

#include "ray/shadow_planes.h"
#include "ray/shadow_query.h"

namespace prt::ray {
namespace {

constexpr std::uint32_t kNoTriangle = 0xffffffffu;

/// The ray and the passes' constants. s is the depth along axis m: t = s / length.
struct RayFrame {
  float near_origin[3], far_origin[3];  ///< for bounds by which it enters and leaves wider boxes
  Lanes reciprocal[3];                  ///< of the direction, made 1 along m, by axis
  int near[3], far[3];  ///< rows of a node's bounds that face the origin and look away
  int p, q, m;
  Lanes o[3];  ///< the origin's coordinates p, q, m
  Lanes minus_u, minus_v;
  Lanes sign;    ///< that of the direction along m
  float length;  ///< of the direction along m
  float s_near, s_far;
};

PRT_LANES float magnitude(float a) { return a < 0.0f ? -a : a; }

PRT_LANES RayFrame make_frame(const RayQuery& query) {
  const float *d = query.direction, *o = query.origin;
  // 8 units of rounding of the largest coordinate: distances from the origin are up to twice that,
  // and a corner's x has the roundings of its distance, of its depth, times u, and of u, times its
  // depth: 6. One more is for the origins made here.
  float largest = 1.0f;
  for (int axis = 0; axis < 3; ++axis) {
    if (magnitude(o[axis]) > largest) largest = magnitude(o[axis]);
  }
  const float margin = 0x1p-21f * largest;
  RayFrame f;
  f.m = magnitude(d[1]) > magnitude(d[0]) ? 1 : 0;
  if (magnitude(d[2]) > magnitude(d[f.m])) f.m = 2;
  f.p = f.m == 2 ? 0 : f.m + 1, f.q = f.p == 2 ? 0 : f.p + 1;
  f.length = magnitude(d[f.m]);
  for (int axis = 0; axis < 3; ++axis) {
    // Smaller ones move a ray less than rounding does.
    constexpr float kLeast = 1e-18f;
    const float along = d[axis] / f.length;
    const bool negative = __builtin_signbit(along);
    const float safe = magnitude(along) >= kLeast ? along : negative ? -kLeast : kLeast;
    f.reciprocal[axis] = broadcast(1.0f / safe);
    f.near[axis] = negative ? 3 + axis : axis;
    f.far[axis] = negative ? axis : 3 + axis;
    f.near_origin[axis] = negative ? o[axis] - margin : o[axis] + margin;
    f.far_origin[axis] = negative ? o[axis] + margin : o[axis] - margin;
  }
  f.o[0] = broadcast(o[f.p]), f.o[1] = broadcast(o[f.q]), f.o[2] = broadcast(o[f.m]);
  f.minus_u = broadcast(-d[f.p] / f.length), f.minus_v = broadcast(-d[f.q] / f.length);
  f.sign = broadcast(d[f.m] < 0.0f ? -0.0f : 0.0f);
  f.s_near = query.t_near * f.length, f.s_far = query.t_far * f.length;
  return f;
}

/// Children of a node that the ray meets before s_far; `entry`: where.
PRT_LANES Mask meet_children(const ShadowNode& node, const RayFrame& f, float s_far, Lanes& entry) {
  // 16 units of rounding, 2^-24: 3 of a bound's s, at both ends, are 6.
  constexpr float kBeyond = 1.0f + 0x1p-20f;
  Lanes near = broadcast(f.s_near), far = broadcast(s_far);
#pragma GCC unroll 3
  for (int axis = 0; axis < 3; ++axis) {
    const Lanes in = broadcast(f.near_origin[axis]), out = broadcast(f.far_origin[axis]);
    near = max(near, (load(node.bounds[f.near[axis]]) - in) * f.reciprocal[axis]);
    far = min(far, (load(node.bounds[f.far[axis]]) - out) * f.reciprocal[axis]);
  }
  entry = near;
  return le(0xffffu, near, far * broadcast(kBeyond));
}

/// What a leaf's triangles make of the ray, where `hits` says so.
struct LeafHits {
  Mask hits;
  Lanes s, v, w, det;  ///< v / det and w / det are weights of corners 1 and 2; det > 0
  Mask back;
};

PRT_LANES LeafHits meet_leaf(const float* leaf, unsigned count, const RayFrame& f, float s_far) {
  const Lanes zero = broadcast(0.0f);
  Lanes x[3], y[3], z[3];
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    const float* rows = leaf + static_cast<unsigned>(3 * i) * count;
    z[i] = (load(rows + static_cast<unsigned>(f.m) * count) - f.o[2]) ^ f.sign;
    x[i] = fma(f.minus_u, z[i], load(rows + static_cast<unsigned>(f.p) * count) - f.o[0]);
    y[i] = fma(f.minus_v, z[i], load(rows + static_cast<unsigned>(f.q) * count) - f.o[1]);
  }
  LeafHits r;
  const Lanes a = x[1] * y[2] - y[1] * x[2], b = x[2] * y[0] - y[2] * x[0],
              c = x[0] * y[1] - y[0] * x[1];
  const Mask used = (1u << count) - 1;
  const Mask positive = le(used, zero, min3(a, b, c)), negative = le(used, max3(a, b, c), zero);
  r.hits = positive | negative;
  if (r.hits == 0) return r;
  const Lanes det = a + b + c, sign = det & broadcast(-0.0f);
  r.det = det ^ sign, r.v = b ^ sign, r.w = c ^ sign;
  r.s = fma(a ^ sign, z[0], fma(r.v, z[1], r.w * z[2])) / r.det;
  r.hits = lt(r.hits, zero, r.det);
  r.hits = lt(r.hits, broadcast(f.s_near), r.s);
  r.hits = le(r.hits, r.s, broadcast(s_far));
  r.back = lt(used, zero, det ^ f.sign);
  return r;
}

constexpr int kRayStackSize = kMaxTreeDepth * (kNodeWidth - 1) + 1;

/// The front of a triangle is turned towards d where its projection along +m turns clockwise.
PRT_LANES void keep_closest(const LeafHits& leaf, const std::uint32_t* numbers, RayAnswer& best,
                            float& s_far) {
  alignas(64) float s[16], v[16], w[16], det[16];
  store(s, leaf.s), store(v, leaf.v), store(w, leaf.w), store(det, leaf.det);
  for (Mask hits = leaf.hits; hits != 0; hits &= hits - 1) {
    const int i = __builtin_ctz(hits);
    if (s[i] > s_far || (s[i] == s_far && numbers[i] > best.triangle)) continue;
    s_far = s[i];
    best = {numbers[i], s[i], v[i] / det[i], w[i] / det[i], (leaf.back >> i & 1) != 0};
  }
}

PRT_LANES RayAnswer find_closest(const WideTreeView& tree, const RayQuery& query) {
  struct Entry {
    float s;
    std::uint32_t child, triangle_count;
  };
  const RayFrame frame = make_frame(query);
  RayAnswer best{kNoTriangle, 0.0f, 0.0f, 0.0f, false};
  float s_far = frame.s_far;
  Entry stack[kRayStackSize];
  stack[0] = {frame.s_near, tree.root, 0};
  for (int depth = 1; depth > 0;) {
    const Entry at = stack[--depth];
    if (at.s > s_far * (1.0f + 0x1p-20f)) continue;
    if (at.triangle_count > 0) {
      const LeafHits leaf =
          meet_leaf(tree.triangles + std::size_t{9} * at.child, at.triangle_count, frame, s_far);
      if (leaf.hits != 0) keep_closest(leaf, tree.numbers + at.child, best, s_far);
      continue;
    }
    const ShadowNode& node = tree.nodes[at.child];
    alignas(64) float entry[kNodeWidth];
    Lanes near;
    Mask children = meet_children(node, frame, s_far, near);
    store(entry, near);
    // The nearest comes to lie on top.
    for (const int bottom = depth; children != 0; children &= children - 1) {
      const int i = __builtin_ctz(children);
      int place = depth++;
      for (; place > bottom && stack[place - 1].s < entry[i]; --place) {
        stack[place] = stack[place - 1];
      }
      stack[place] = {entry[i], node.child[i], node.triangle_count[i]};
    }
  }
  best.t /= frame.length;
  return best;
}

PRT_LANES bool is_occluded(const WideTreeView& tree, const RayQuery& query) {
  const RayFrame frame = make_frame(query);
  std::uint32_t stack[kRayStackSize];
  stack[0] = tree.root;
  for (int depth = 1; depth > 0;) {
    const ShadowNode& node = tree.nodes[stack[--depth]];
    Lanes near;
    for (Mask children = meet_children(node, frame, frame.s_far, near); children != 0;
         children &= children - 1) {
      const int i = __builtin_ctz(children);
      if (node.triangle_count[i] == 0) {
        stack[depth++] = node.child[i];
        continue;
      }
      const float* leaf = tree.triangles + std::size_t{9} * node.child[i];
      if (meet_leaf(leaf, node.triangle_count[i], frame, frame.s_far).hits != 0) return true;
    }
  }
  return false;
}

}  // namespace
}  // namespace prt::ray
