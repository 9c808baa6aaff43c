#include "core/cpu.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace prt {

namespace {

SimdLevel detect() {
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) {
    return SimdLevel::avx512;
  }
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return SimdLevel::avx2;
  return SimdLevel::baseline;
}

SimdLevel choose() {
  const SimdLevel best = detect();
  const char* wish = std::getenv("PRTKIT_SIMD");
  if (!wish) return best;
  for (SimdLevel level : {SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512}) {
    if (std::string_view(wish) == simd_level_name(level)) return std::min(level, best);
  }
  return best;
}

}  // namespace

SimdLevel simd_level() {
  static const SimdLevel level = choose();
  return level;
}

const char* simd_level_name(SimdLevel level) {
  switch (level) {
    case SimdLevel::avx512:
      return "avx512";
    case SimdLevel::avx2:
      return "avx2";
    default:
      return "baseline";
  }
}

}  // namespace prt
