#include "transfer/limits.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace prt::transfer {

void check_range(const char* name, int value, int low, int high) {
  if (value >= low && value <= high) return;
  throw Error(ErrorKind::usage, fmt::format("{} out of range", name),
              {.found = fmt::format("{}", value), .expected = fmt::format("{} to {}", low, high)});
}

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
