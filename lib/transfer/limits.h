// Ranges of options that the kinds of transfer share.
#pragma once

namespace prt::transfer {

constexpr int kMaxRayCount = 1 << 17;  ///< per vertex

/// Throws Error (usage) when low <= value <= high does not hold.
void check_range(const char* name, int value, int low, int high);

}  // namespace prt::transfer
