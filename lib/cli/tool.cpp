#include "cli/tool.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <new>

#include "core/atomic_file.h"
#include "core/cpu.h"
#include "core/error.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/progress.h"

namespace prt::cli {

namespace {

constexpr const char* kCommonGroup = "Common";
constexpr int kFailed = 1;
constexpr int kWrongUsage = 2;

void apply(const CommonOptions& options) {
  set_thread_count(options.threads);
  set_progress_policy(options.progress, options.quiet);
  log::set_level(options.quiet     ? log::Level::error
                 : options.verbose ? log::Level::debug
                                   : log::Level::info);
}

/// Most options are floats, which 1e40 would make infinite, and not all have a range.
void check_finite(const CLI::Option& option) {
  for (const std::string& value : option.results()) {
    if (std::isfinite(std::strtof(value.c_str(), nullptr))) continue;
    throw Error(ErrorKind::usage, option.get_name() + ": not a finite number", {.found = value});
  }
}

/// CLI11 2.1 takes -1 for the largest unsigned number, and so it does larger ones.
void check_unsigned(const CLI::Option& option) {
  for (const std::string& value : option.results()) {
    errno = 0;
    std::strtoull(value.c_str(), nullptr, 0);
    if (!value.starts_with('-') && errno == 0) continue;
    throw Error(ErrorKind::usage, option.get_name() + ": out of range",
                {.found = value, .expected = "0 to 18446744073709551615"});
  }
}

/// "Could not convert: NAME = VALUE", by what the option takes.
std::string conversion_message(const CLI::App& app, const std::string& what) {
  const std::size_t colon = what.find(": "), equals = what.find(" = ");
  const std::string name = what.substr(colon + 2, equals - colon - 2);
  const std::string type = app.get_option(name)->get_type_name();
  return fmt::format("{}: expected {}, found {}", name,
                     type == "FLOAT"                   ? "a number"
                     : type == "INT" || type == "UINT" ? "a whole number"
                                                       : "numbers " + type,
                     what.substr(equals + 3));
}

/// CLI11 calls a missing value by the types of its checks, and lists unknown arguments backwards.
std::string message_of(const CLI::App& app, const CLI::Error& error) {
  const std::string what = error.what();
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)) {
    return fmt::format("not understood: {}", fmt::join(app.remaining(true), " "));
  }
  if (error.get_name() == "ArgumentMismatch" && what.ends_with(" missing")) {
    return what.substr(0, what.find(':')) + ": a value is missing";
  }
  if (what.starts_with("Could not convert: ")) return conversion_message(app, what);
  return what;
}

/// Results that do not arrive (a full disk, a closed pipe) are a failure.
void flush_results() {
  std::cout.flush();
  if (!std::cout || std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    throw_failed("writing to the standard output failed");
  }
}

}  // namespace

Tool::Tool(std::string name, std::string description, std::string example)
    : name_(std::move(name)),
      app_(std::make_unique<CLI::App>(std::move(description), name_)),
      options_(*app_) {
  app_->footer("Example:\n  " + example);
  app_->get_formatter()->column_width(34);
  // The last of repeated options counts, so that makefiles and scripts can override their defaults.
  app_->option_defaults()->always_capture_default()->multi_option_policy(
      CLI::MultiOptionPolicy::TakeLast);
  app_->set_version_flag("--version", [this] { return version(); });
  app_->failure_message([this](const CLI::App* app, const CLI::Error& error) {
    const std::string what = message_of(*app, error);
    return fmt::format("{}: {}{} {} --help says more.\n", name_, what,
                       what.ends_with('.') ? "" : ".", name_);
  });
  const char* group = kCommonGroup;
  options_.add_option("--threads", common_.threads, "Threads; 0: all")
      ->check(Range(0, 1024))
      ->group(group);
  options_.add_option("--report", common_.report, "Write a JSON report of the run")->group(group);
  options_.add_flag("--no-clobber", common_.no_clobber, "Fail when the output exists")
      ->group(group);
  options_.add_flag("--progress", common_.progress, "Show progress off a terminal too")
      ->group(group);
  options_.add_flag("-v,--verbose", common_.verbose, "Say more")->group(group);
  options_.add_flag("-q,--quiet", common_.quiet, "Say nothing but errors")->group(group);
}

Tool::~Tool() = default;

Option* Tool::add_seed() {
  return options_.add_option("--seed", common_.seed, "Seed of everything random")
      ->group(kCommonGroup);
}

void Tool::add_component(const std::string& name, const std::function<std::string()>& describe) {
  components_.emplace_back(name, describe);
}

std::string Tool::version() const {
  std::string text =
      fmt::format("{} {} ({})", name_, PRTKIT_VERSION, simd_level_name(simd_level()));
  if (app_->count("--verbose") == 0) return text;
  for (const auto& [name, describe] : components_)
    text += fmt::format("\n{}: {}", name, describe());
  return text;
}

void Tool::record_options(Report& report) const {
  for (const CLI::Option* option : app_->get_options()) {
    const std::string& name = option->get_name(false, false);
    if (option->count() == 0 || name == "--help" || name == "--version") continue;
    const auto values = option->as<std::vector<std::string>>();
    report.json()["options"][name] = fmt::format("{}", fmt::join(values, ","));
  }
}

void Tool::check_values() const {
  for (const CLI::Option* option : app_->get_options()) {
    const CLI::results_t& values = option->results();
    const auto count = static_cast<std::size_t>(option->get_items_expected_min());
    if (std::ranges::count(values, "") > 0) {
      throw Error(ErrorKind::usage, option->get_name() + ": empty");
    }
    if (count > 1 && values.size() % count != 0) {
      throw Error(ErrorKind::usage, option->get_name() + ": wrong count",
                  {.found = fmt::format("{}", fmt::join(values, ",")),
                   .expected = fmt::format("{} values", count)});
    }
    if (option->get_type_name().starts_with("FLOAT")) check_finite(*option);
    if (option->get_type_name().starts_with("UINT")) check_unsigned(*option);
  }
}

int Tool::execute(const std::function<void(Report&)>& work) {
  check_values();
  apply(common_);
  if (!common_.report.empty()) check_output(common_.report, common_.no_clobber);
  Report report(name_);
  record_options(report);
  work(report);
  flush_results();
  if (!common_.report.empty()) report.write(common_.report, common_.no_clobber);
  return 0;
}

int Tool::run(int argc, char** argv, const std::function<void(Report&)>& work) {
  try {
    app_->parse(argc, argv);
    return execute(work);
  } catch (const CLI::ParseError& error) {
    const bool asked = app_->exit(error) == 0;  // --help, --version
    return !asked ? kWrongUsage : std::cout.flush() ? 0 : kFailed;
  } catch (const Error& error) {
    fmt::print(stderr, "{}: {}\n", name_, error.what());
    return error.exit_status();
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "{}: out of memory\n", name_);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", name_, error.what());
  }
  return kFailed;
}

}  // namespace prt::cli
