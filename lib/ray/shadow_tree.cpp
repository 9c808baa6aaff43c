#include "ray/shadow_tree.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace prt::ray {

ShadowTree::ShadowTree(const Triangles& triangles, SimdLevel level) : level_(level) {
  check_triangles(triangles);
  tree_ = std::make_shared<const WideTree>(TriangleSource::of(triangles));
}

void ShadowTree::trace(const Vec3& origin, const Vec3& normal, std::span<const Beam> beams,
                       std::span<BeamLanes> lanes) const {
  assert(lanes.size() == beams.size());
  const Vec3 o = origin * tree_->scale();
  // Roundings of the nodes' tests are below 14 units of 2^-24 of the largest coordinate.
  const float margin = 0x1p-20f * std::max({1.0f, std::abs(o.x), std::abs(o.y), std::abs(o.z)});
  const ShadowQuery query{{o.x, o.y, o.z}, {normal.x, normal.y, normal.z}, margin};
  kernel_for(level_, trace_shadows_avx512, trace_shadows_avx2, trace_shadows_baseline)(
      tree_->view(), query, beams.data(), beams.size(), lanes.data());
  trim_mapped_arrays();
}

}  // namespace prt::ray
