// Rays from one origin, a beam of 16 neighbouring directions after the other, against a tree of
// triangles. Compiled once for each instruction set.
//
// Each beam has its own frame: x, y, z are the coordinates p, q, m of shadow_query.h, relative to
// the origin, z along the beam; a direction is (u, v, 1). With a common origin, whether a ray hits
// the triangle a0 a1 a2 is the sign of three dot products with normals of the planes through its
// edges and the origin,
//
//   N_ij = a_i × a_j = a_i × (a_j - a_i),   sign(det) N_ij · (u, v, 1) >= -slack_ij for the three
//   edges, sign(det) G · (u, v, 1) > 0,   G = (a1 - a0) × (a2 - a0), det = G · a0:  t > 0,
//
// and its box: u in [min x / z, max x / z] over the box, as products. N_ij is made from the nearer
// of the two corners, which is exact to a few units in the last place of |a_i| |a_j - a_i|; slack
// is the bound of all roundings, so that a ray that hits the triangle whose corners are the rounded
// a_i is always counted, and no ray slips between triangles that share corners. The box keeps a
// needle's slack from reaching beyond its ends. All of it depends on origin, direction and triangle
// alone.
//
// What spares work only leaves out rays that fail the test above, rounding included: boxes of
// leaves and beams are compared in products that are monotonic in their arguments, boxes of inner
// nodes with a margin.
#pragma once

#include "ray/shadow_planes.h"
#include "ray/shadow_query.h"

namespace prt::ray {
namespace {

static_assert(kBeamLanes == 16 && kNodeWidth == 16);

/// The beam and the origin as the passes need them.
struct Frame {
  float p, q, m;      ///< the origin's coordinates
  float direction;    ///< +1 or -1, along m
  Lanes sign;         ///< its sign
  int near_m, far_m;  ///< rows of a node's bounds that face the origin and look away
  Range range;
  Lanes u, v;
};

/// Lanes that may meet a box, of `lanes`; x, y and z are its bounds in the frame.
PRT_LANES Mask meets_box(Mask lanes, const Lanes& u, const Lanes& v, const Lanes3& lower,
                         const Lanes3& upper) {
  const Lanes zero = broadcast(0.0f), near = max(lower.z, zero);
  const Lanes u_near = u * near, u_far = u * upper.z, v_near = v * near, v_far = v * upper.z;
  lanes = le(lanes, lower.x, max(u_near, u_far));
  lanes = le(lanes, min(u_near, u_far), upper.x);
  lanes = le(lanes, lower.y, max(v_near, v_far));
  lanes = le(lanes, min(v_near, v_far), upper.y);
  return le(lanes, zero, upper.z);
}

/// Triangles of `hits` whose box the ray (u, v) meets.
PRT_LANES Mask confirm(Mask hits, const Lanes3 a[3], const Lanes& u, const Lanes& v) {
  const Lanes3 lower{min3(a[0].x, a[1].x, a[2].x), min3(a[0].y, a[1].y, a[2].y),
                     min3(a[0].z, a[1].z, a[2].z)};
  const Lanes3 upper{max3(a[0].x, a[1].x, a[2].x), max3(a[0].y, a[1].y, a[2].y),
                     max3(a[0].z, a[1].z, a[2].z)};
  return meets_box(hits, u, v, lower, upper);
}

/// Lanes, of `lanes`, that a leaf of `count` triangles blocks.
template <int m>
PRT_LANES Mask trace_leaf(const float* leaf, unsigned count, const Beam& beam, const Frame& frame,
                          Mask lanes) {
  constexpr int p = (m + 1) % 3, q = (m + 2) % 3, kFew = 4;
  const Lanes zero = broadcast(0.0f);
  Lanes3 a[3];
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    const float* rows = leaf + static_cast<unsigned>(3 * i) * count;
    a[i] = {load(rows + static_cast<unsigned>(p) * count) - broadcast(frame.p),
            load(rows + static_cast<unsigned>(q) * count) - broadcast(frame.q),
            (load(rows + static_cast<unsigned>(m) * count) - broadcast(frame.m)) ^ frame.sign};
  }
  const Planes planes = planes_of(a);
  Mask alive = lt((1u << count) - 1, zero, planes.height);
  if (__builtin_popcount(lanes) > kFew) {
    alive = lt(alive, zero, largest_product(planes.facing, frame.range));
    for (const Lanes3& edge : planes.edges) {
      alive = le(alive, zero, largest_product(edge, frame.range));
    }
    if (alive == 0) return 0;
  }
  Mask blocked = 0;
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = __builtin_ctz(lanes);
    const Lanes u = broadcast(beam.u[lane]), v = broadcast(beam.v[lane]);
    Mask hits = lt(alive, zero, product(planes.facing, u, v));
    for (const Lanes3& edge : planes.edges) hits = le(hits, zero, product(edge, u, v));
    if (hits != 0 && confirm(hits, a, u, v) != 0) blocked |= 1u << lane;
  }
  return blocked;
}

/// Lanes that may meet the box of child i.
template <int m>
PRT_LANES Mask meets_child(const ShadowNode& node, int i, const Frame& frame, Mask lanes) {
  constexpr int p = (m + 1) % 3, q = (m + 2) % 3;
  const auto relative = [&](int row, float origin) __attribute__((always_inline)) {
    return broadcast(node.bounds[row][i] - origin);
  };
  const Lanes3 lower{relative(p, frame.p), relative(q, frame.q),
                     relative(frame.near_m, frame.m) ^ frame.sign};
  const Lanes3 upper{relative(3 + p, frame.p), relative(3 + q, frame.q),
                     relative(frame.far_m, frame.m) ^ frame.sign};
  return meets_box(lanes, frame.u, frame.v, lower, upper);
}

/// Tests 16 children's boxes against a beam. A bound x of a box lies within the beam's plane
/// x = u z when x_p <= k z_m + c, in the scene's coordinates: the origin is in c, with a margin.
template <int m>
struct ChildTest {
  static constexpr int p = (m + 1) % 3, q = (m + 2) % 3;
  struct Plane {
    Lanes k, c;
    int row;  ///< of z, the end of the box where k z reaches furthest
  };
  Plane u_min, u_max, v_min, v_max;
  Lanes direction, behind;
  int far_m;

  PRT_LANES ChildTest(const Frame& frame, const float range[4], float margin)
      : u_min(plane(frame, range[0], frame.p, -margin)),
        u_max(plane(frame, range[1], frame.p, margin)),
        v_min(plane(frame, range[2], frame.q, -margin)),
        v_max(plane(frame, range[3], frame.q, margin)),
        direction(broadcast(frame.direction)),
        behind(broadcast(frame.direction * frame.m - margin)),
        far_m(frame.far_m) {}

  PRT_LANES Mask operator()(const ShadowNode& node) const {
    Mask in = le(0xffffu, behind, direction * load(node.bounds[far_m]));
    in = le(in, load(node.bounds[p]), at(node, u_max));
    in = le(in, at(node, u_min), load(node.bounds[3 + p]));
    in = le(in, load(node.bounds[q]), at(node, v_max));
    return le(in, at(node, v_min), load(node.bounds[3 + q]));
  }

 private:
  PRT_LANES static Plane plane(const Frame& frame, float bound, float origin, float margin) {
    const float k = frame.direction * bound;
    const bool far = (bound >= 0.0f) == (margin > 0.0f);
    return {broadcast(k), broadcast(origin - k * frame.m + margin),
            far ? frame.far_m : frame.near_m};
  }
  PRT_LANES static Lanes at(const ShadowNode& node, const Plane& plane) {
    return fma(plane.k, load(node.bounds[plane.row]), plane.c);
  }
};

/// Lanes, of `lanes`, along which something lies.
template <int m>
Mask trace_beam(const WideTreeView& tree, const ShadowQuery& query, const Beam& beam, Mask lanes) {
  constexpr int p = (m + 1) % 3, q = (m + 2) % 3;
  float range[4] = {beam.u_min, beam.u_max, beam.v_min, beam.v_max};
  if (lanes != (1u << beam.lane_count) - 1) {
    range[0] = range[2] = 1.0f, range[1] = range[3] = -1.0f;
    for (Mask rest = lanes; rest != 0; rest &= rest - 1) {
      const float u = beam.u[__builtin_ctz(rest)], v = beam.v[__builtin_ctz(rest)];
      range[0] = u < range[0] ? u : range[0], range[1] = u > range[1] ? u : range[1];
      range[2] = v < range[2] ? v : range[2], range[3] = v > range[3] ? v : range[3];
    }
  }
  const Frame frame{
      query.origin[p],
      query.origin[q],
      query.origin[m],
      beam.negative ? -1.0f : 1.0f,
      broadcast(beam.negative ? -0.0f : 0.0f),
      beam.negative ? 3 + m : m,
      beam.negative ? m : 3 + m,
      {broadcast(range[0]), broadcast(range[1]), broadcast(range[2]), broadcast(range[3])},
      load(beam.u),
      load(beam.v)};
  const ChildTest<m> meets_beam(frame, range, query.margin);
  std::uint32_t stack[kMaxTreeDepth * (kNodeWidth - 1) + 1] = {tree.root};
  Mask open = lanes;
  for (int depth = 1; depth > 0;) {
    const ShadowNode& node = tree.nodes[stack[--depth]];
    for (Mask children = meets_beam(node); children != 0; children &= children - 1) {
      const int i = __builtin_ctz(children);
      if (node.triangle_count[i] == 0) {
        stack[depth++] = node.child[i];
        continue;
      }
      const Mask near = meets_child<m>(node, i, frame, open);
      if (near == 0) continue;
      const float* leaf = tree.triangles + std::size_t{9} * node.child[i];
      open &= ~trace_leaf<m>(leaf, node.triangle_count[i], beam, frame, near);
      if (open == 0) return lanes;
    }
  }
  return lanes & ~open;
}

PRT_LANES Mask above_horizon(const Beam& beam, const float normal[3]) {
  const Lanes cosine =
      fma(broadcast(normal[0]), load(beam.x),
          fma(broadcast(normal[1]), load(beam.y), broadcast(normal[2]) * load(beam.z)));
  return lt((1u << beam.lane_count) - 1, broadcast(0.0f), cosine);
}

PRT_LANES void trace_beams(const WideTreeView& tree, const ShadowQuery& query, const Beam* beams,
                           std::size_t beam_count, BeamLanes* lanes) {
  for (std::size_t i = 0; i < beam_count; ++i) {
    const Beam& beam = beams[i];
    const Mask above = above_horizon(beam, query.normal);
    Mask blocked = 0;
    if (above != 0) {
      blocked = beam.axis == 0   ? trace_beam<0>(tree, query, beam, above)
                : beam.axis == 1 ? trace_beam<1>(tree, query, beam, above)
                                 : trace_beam<2>(tree, query, beam, above);
    }
    lanes[i] = {static_cast<std::uint16_t>(above), static_cast<std::uint16_t>(blocked)};
  }
}

}  // namespace
}  // namespace prt::ray
