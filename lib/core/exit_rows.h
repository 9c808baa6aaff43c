// How many exit rows transfer can have, which readers of its files check: 1 is exit radiance
// itself, n² and n² - 1 are the sets of functions over the hemisphere of sh/hemisphere.h.
#pragma once

namespace prt {

constexpr int kMaxExitRowCount = 256;
constexpr const char* kExitRowCounts = "1, or n² or n² - 1";

constexpr bool is_exit_row_count(int count) {
  int band_count = 1;
  while (band_count * band_count < count) ++band_count;
  return count >= 1 && count <= kMaxExitRowCount && count >= band_count * band_count - 1;
}

}  // namespace prt
