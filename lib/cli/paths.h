// Which files a tool may read and write in one run, asked before the work.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/tool.h"

namespace prt::cli {

/// A file that a tool is going to write.
struct Output {
  std::filesystem::path path;           ///< empty: not wanted in this run
  std::vector<std::string> extensions;  ///< that the tool writes: ".png", …
  std::filesystem::path in_place;       ///< the input that it may replace, or empty
};

/// Throws Error (usage) when an output has an extension that the tool does not write, when two
/// outputs are one file, or when an output or the report is one of the inputs; Error (failed) when
/// an output cannot be written (core/atomic_file.h check_output). Empty paths are left out.
void check_paths(const std::vector<std::filesystem::path>& inputs,
                 const std::vector<Output>& outputs, const CommonOptions& common);

}  // namespace prt::cli
