#include "cli/paths.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/file.h"

namespace prt::cli {

namespace {

namespace fs = std::filesystem;

bool same_file(const fs::path& a, const fs::path& b) {
  if (a.empty() || b.empty()) return false;
  std::error_code code;
  return fs::equivalent(a, b, code) ||
         fs::weakly_canonical(fs::absolute(a), code) == fs::weakly_canonical(fs::absolute(b), code);
}

void check_different(const fs::path& written, const char* role, const fs::path& other) {
  if (same_file(written, other)) {
    throw Error(ErrorKind::usage, fmt::format("is {} as well", role),
                {.file = written.string(), .advice = "Give another name."});
  }
}

void check_extension(const Output& output) {
  const std::string found = lower_extension(output.path);
  if (std::ranges::count(output.extensions, found) > 0) return;
  std::error_code code;
  if (fs::is_directory(output.path, code)) {
    throw Error(ErrorKind::usage, "is a folder",
                {.file = output.path.string(), .advice = "Give the name of a file in it."});
  }
  throw Error(ErrorKind::usage, "not a kind of file that this tool writes",
              {.file = output.path.string(),
               .found = fmt::format("\"{}\"", found),
               .expected = fmt::format("{}", fmt::join(output.extensions, " or "))});
}

}  // namespace

void check_paths(const std::vector<fs::path>& inputs, const std::vector<Output>& outputs,
                 const CommonOptions& common) {
  for (const fs::path& input : inputs) {
    if (!input.empty()) check_input(input);
    check_different(common.report, "an input", input);
  }
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const Output& output = outputs[i];
    if (output.path.empty()) continue;
    check_extension(output);
    check_different(common.report, "an output", output.path);
    for (std::size_t j = 0; j < i; ++j) {
      check_different(output.path, "another output", outputs[j].path);
    }
    for (const fs::path& input : inputs) {
      if (input != output.in_place) check_different(output.path, "an input", input);
    }
    check_output(output.path, common.no_clobber);
  }
}

}  // namespace prt::cli
