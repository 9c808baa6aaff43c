#include "ray/shadow_kernel.h"

namespace prt::ray {

void trace_shadows_baseline(const ShadowTreeView& tree, const ShadowQuery& query, const Beam* beams,
                            std::size_t beam_count, BeamLanes* lanes) {
  trace_beams(tree, query, beams, beam_count, lanes);
}

}  // namespace prt::ray
