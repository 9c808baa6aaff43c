// What every tool's command line shares (docs/architecture.md, "Command line"): common options,
// help, version, exit statuses, the run report.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cli/options.h"
#include "core/report.h"

namespace prt::cli {

/// Options that every tool takes, but for the seed.
struct CommonOptions {
  int threads = 0;         ///< 0: all processors
  std::uint64_t seed = 1;  ///< of tools with add_seed
  bool no_clobber = false;
  bool verbose = false;
  bool quiet = false;
  bool progress = false;         ///< force progress off a terminal
  std::filesystem::path report;  ///< empty: none
};

class Tool {
 public:
  /// `example` is one real command, shown at the end of --help.
  Tool(std::string name, std::string description, std::string example);
  ~Tool();

  Options& options() { return options_; }
  const CommonOptions& common() const { return common_; }

  /// --seed, for tools that draw random numbers.
  Option* add_seed();

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
  std::unique_ptr<CLI::App> app_;
  Options options_;
  CommonOptions common_;
  std::vector<std::pair<std::string, std::function<std::string()>>> components_;
};

}  // namespace prt::cli
