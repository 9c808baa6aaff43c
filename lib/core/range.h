// Ranges of options.
#pragma once

namespace prt {

/// Throws Error (usage) when low <= value <= high does not hold.
void check_range(const char* name, int value, int low, int high);

}  // namespace prt
