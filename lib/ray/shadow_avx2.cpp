#include "ray/ray_kernel.h"
#include "ray/shadow_kernel.h"

namespace prt::ray {

void trace_shadows_avx2(const WideTreeView& tree, const ShadowQuery& query, const Beam* beams,
                        std::size_t beam_count, BeamLanes* lanes) {
  trace_beams(tree, query, beams, beam_count, lanes);
}

RayAnswer find_closest_avx2(const WideTreeView& tree, const RayQuery& query) {
  return find_closest(tree, query);
}

bool is_occluded_avx2(const WideTreeView& tree, const RayQuery& query) {
  return is_occluded(tree, query);
}

}  // namespace prt::ray
