#include "transfer/limits.h"

#include <algorithm>

#include "core/error.h"
#include "core/range.h"

namespace prt::transfer {

void check_bounces(int bounce_count, int bounce_ray_count, bool shadowed) {
  check_range("bounce count", bounce_count, 0, 1000);
  check_range("bounce ray count", bounce_ray_count, 0, kMaxBounceRayCount);
  if (bounce_count > 0 && !shadowed) {
    throw Error(ErrorKind::usage, "bounces need shadows",
                {.advice = "Leave out one of unshadowed and bounces."});
  }
}

int choose_bounce_ray_count(int bounce_ray_count, int ray_count) {
  if (bounce_ray_count > 0) return bounce_ray_count;
  return std::min((ray_count + 3) / 4, kMaxBounceRayCount);
}

}  // namespace prt::transfer
