// Where a tool keeps unfinished work (docs/architecture.md, "Command line").
#pragma once

#include <filesystem>

#include "core/checkpoint.h"

namespace prt::cli {

/// OUTPUT.partial, after ten seconds or what the environment variable PRTKIT_CHECKPOINT_SECONDS
/// says. Throws Error (usage) when that is not a number from 0 up.
CheckpointOptions checkpoint_beside(const std::filesystem::path& output);

}  // namespace prt::cli
