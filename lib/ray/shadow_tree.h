// Shadow rays as a bake casts them: from one origin in a thousand directions that all origins
// share, anything at any distance blocks. Knowing that, beams of neighbouring directions go through
// a tree of 16-wide nodes together, the planes of a triangle through the origin are found once for
// a beam, and a ray costs three dot products a triangle, 16 triangles at a time (shadow_kernel.h):
// about twice as fast as Embree's robust mode, and tighter: rays aimed at vertices do not pass.
#pragma once

#include <memory>
#include <span>
#include <utility>

#include "core/cpu.h"
#include "ray/beams.h"
#include "ray/wide_tree.h"

namespace prt::ray {

class ShadowTree {
 public:
  /// Copies what it needs, some 49 bytes a triangle. Throws as make_embree_engine does.
  explicit ShadowTree(const Triangles& triangles, SimdLevel level = simd_level());
  explicit ShadowTree(std::shared_ptr<const WideTree> tree, SimdLevel level = simd_level())
      : level_(level), tree_(std::move(tree)) {}

  /// Casts a ray from the origin (t > 0) in each direction d with normal · d > 0 and tells which
  /// are blocked, by front or back. lanes.size() == beams.size(). Thread safe; the answer depends
  /// on the origin, the direction and the triangles only, not on their order.
  void trace(const Vec3& origin, const Vec3& normal, std::span<const Beam> beams,
             std::span<BeamLanes> lanes) const;

 private:
  SimdLevel level_;
  std::shared_ptr<const WideTree> tree_;
};

}  // namespace prt::ray
