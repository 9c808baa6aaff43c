#include "cli/checkpoint.h"

#include <charconv>
#include <cstdlib>
#include <cstring>

#include "core/error.h"

namespace prt::cli {

CheckpointOptions checkpoint_beside(const std::filesystem::path& output) {
  CheckpointOptions options{.path = output.string() + ".partial"};
  if (const char* const text = std::getenv("PRTKIT_CHECKPOINT_SECONDS")) {
    const char* const end = text + std::strlen(text);
    const auto [stop, error] = std::from_chars(text, end, options.after_seconds);
    if (error != std::errc() || stop != end || !(options.after_seconds >= 0.0)) {
      throw Error(ErrorKind::usage, "PRTKIT_CHECKPOINT_SECONDS is not a number of seconds",
                  {.found = text, .expected = "0 or more"});
    }
  }
  return options;
}

}  // namespace prt::cli
