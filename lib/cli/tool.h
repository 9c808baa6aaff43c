// What every tool's command line shares (docs/architecture.md, "Command line"): common options,
// help, version, exit statuses, the run report.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/report.h"

namespace prt::cli {

/// Options that every tool takes.
struct CommonOptions {
  int threads = 0;  ///< 0: all processors
  std::uint64_t seed = 1;
  bool no_clobber = false;
  bool verbose = false;
  bool quiet = false;
  bool progress = false;         ///< force progress off a terminal
  std::filesystem::path report;  ///< empty: none
};

/// Checks of an option's number; those of CLI11 name the largest number of all in their message.
CLI::Validator at_least_zero();
CLI::Validator above_zero();

class Tool {
 public:
  /// `example` is one real command, shown at the end of --help.
  Tool(std::string name, std::string description, std::string example);

  CLI::App& app() { return app_; }
  const CommonOptions& common() const { return common_; }

  /// Something whose version or kind `--version -v` tells: "BLAS", asked only then.
  void add_component(const std::string& name, const std::function<std::string()>& describe);

  /// Parses, runs `work`, writes the report, and returns the exit status: 0 done, 1 failed,
  /// 2 wrong usage, 3 bad input file. The work throws prt::Error.
  int run(int argc, char** argv, const std::function<void(Report&)>& work);

 private:
  void check_values() const;
  int execute(const std::function<void(Report&)>& work);
  std::string version() const;
  void record_options(Report& report) const;

  std::string name_;
  CLI::App app_;
  CommonOptions common_;
  std::vector<std::pair<std::string, std::function<std::string()>>> components_;
};

}  // namespace prt::cli
