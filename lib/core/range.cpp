#include "core/range.h"

#include <fmt/format.h>

#include "core/error.h"

namespace prt {

void check_range(const char* name, int value, int low, int high) {
  if (value >= low && value <= high) return;
  throw Error(ErrorKind::usage, fmt::format("{} out of range", name),
              {.found = fmt::format("{}", value), .expected = fmt::format("{} to {}", low, high)});
}

}  // namespace prt
