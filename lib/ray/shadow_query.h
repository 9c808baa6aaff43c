// What the kernels of the wide tree (shadow_kernel.h, ray_kernel.h) work on: plain arrays, no other
// header, for they are compiled with other flags than the rest of the program.
#pragma once

#include <cstddef>
#include <cstdint>

namespace prt::ray {

constexpr int kBeamLanes = 16;

/// Up to 16 neighbouring directions of a list whose largest coordinate is the same one, of the
/// same sign. Axis m is that of the largest coordinate, p and q the next two in cyclic order.
struct Beam {
  float x[kBeamLanes], y[kBeamLanes], z[kBeamLanes];  ///< unused lanes repeat the last used
  float u[kBeamLanes], v[kBeamLanes];                 ///< d_p / |d_m|, d_q / |d_m|
  float u_min, u_max, v_min, v_max;
  std::uint32_t first;  ///< number in the list of the direction in lane 0; the others follow
  std::uint16_t lane_count;
  std::uint8_t axis;  ///< m
  bool negative;      ///< d_m < 0
};

/// Lanes of a beam, a bit each.
struct BeamLanes {
  std::uint16_t above;    ///< directions above the horizon, those that are traced
  std::uint16_t blocked;  ///< of these, those along which something lies
};

constexpr int kNodeWidth = 16;

/// Boxes of up to 16 children. Those of unused slots are inside out and infinite.
struct alignas(64) ShadowNode {
  float bounds[6][kNodeWidth];              ///< lower x, y, z, upper x, y, z
  std::uint32_t child[kNodeWidth];          ///< a node, or the first triangle of a leaf
  std::uint8_t triangle_count[kNodeWidth];  ///< 1 to 16 in a leaf, 0 for a node
};

/// The leaf from triangle k on starts at triangles[9 k]: nine rows of as many floats as it has
/// triangles, the coordinates x, y, z of their corners 0, 1, 2. Loads read up to 15 floats past it.
struct WideTreeView {
  const ShadowNode* nodes;
  std::uint32_t root;
  const float* triangles;
  const std::uint32_t* numbers;  ///< of the triangles, as the caller counts them
};

struct ShadowQuery {
  float origin[3], normal[3];
  float margin;  ///< of the nodes' boxes, more than any rounding of their tests
};

constexpr int kMaxTreeDepth = 48;

void trace_shadows_avx512(const WideTreeView& tree, const ShadowQuery& query, const Beam* beams,
                          std::size_t beam_count, BeamLanes* lanes);
void trace_shadows_avx2(const WideTreeView& tree, const ShadowQuery& query, const Beam* beams,
                        std::size_t beam_count, BeamLanes* lanes);
void trace_shadows_baseline(const WideTreeView& tree, const ShadowQuery& query, const Beam* beams,
                            std::size_t beam_count, BeamLanes* lanes);

/// A ray in the tree's coordinates: origin + t direction, t in (t_near, t_far].
struct RayQuery {
  float origin[3], direction[3], t_near, t_far;
};

struct RayAnswer {
  std::uint32_t triangle;  ///< number; of equal t the lowest. 2^32 - 1: none
  float t, u, v;           ///< as ray::Hit has them
  bool back_face;
};

RayAnswer find_closest_avx512(const WideTreeView& tree, const RayQuery& query);
RayAnswer find_closest_avx2(const WideTreeView& tree, const RayQuery& query);
RayAnswer find_closest_baseline(const WideTreeView& tree, const RayQuery& query);
bool is_occluded_avx512(const WideTreeView& tree, const RayQuery& query);
bool is_occluded_avx2(const WideTreeView& tree, const RayQuery& query);
bool is_occluded_baseline(const WideTreeView& tree, const RayQuery& query);

}  // namespace prt::ray
