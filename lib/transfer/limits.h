// Ranges of options that the kinds of transfer share.
#pragma once

namespace prt::transfer {

constexpr int kMaxRayCount = 1 << 17;        ///< per vertex
constexpr int kMaxBounceRayCount = 1 << 14;  ///< per vertex: a block's hits stay under 17 MB

/// Throws Error (usage) when options of bounces are out of range or lack shadows.
void check_bounces(int bounce_count, int bounce_ray_count, bool shadowed);

/// bounce_ray_count, or, when that is 0, a quarter of ray_count.
int choose_bounce_ray_count(int bounce_ray_count, int ray_count);

}  // namespace prt::transfer
