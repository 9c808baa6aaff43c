// The run report of --report FILE.json: a JSON object that every part of a tool adds its figures
// to. Common keys: tool, version, options, inputs, outputs, stages (name, seconds), seconds,
// peak_memory_bytes, threads, simd.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/stopwatch.h"

namespace prt {

class Report {
 public:
  explicit Report(std::string tool);

  /// The object itself, for figures of the tool's own.
  nlohmann::ordered_json& json() { return json_; }

  /// Adds path, bytes and content hash under "inputs" or "outputs". An input that is missing or not
  /// a regular file is an Error (bad_input).
  void add_input(const std::filesystem::path& path);
  void add_output(const std::filesystem::path& path);

  /// Adds a stage that ran for `seconds`.
  void add_stage(const std::string& name, double seconds);

  /// Fills in seconds, peak memory and threads, and writes the file (atomically).
  void write(const std::filesystem::path& path, bool no_clobber);

 private:
  nlohmann::ordered_json json_;
  Stopwatch stopwatch_;
};

/// Times a scope as one stage of a report.
class StageTimer {
 public:
  StageTimer(Report& report, std::string name) : report_(report), name_(std::move(name)) {}
  ~StageTimer() { report_.add_stage(name_, stopwatch_.seconds()); }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  Report& report_;
  std::string name_;
  Stopwatch stopwatch_;
};

/// JSON as text, in one line or indented. Names and paths may hold any bytes: those that are not
/// UTF-8 become U+FFFD, instead of an exception.
std::string json_text(const nlohmann::ordered_json& json, int indent = -1);

/// Peak resident memory of this process so far, in bytes.
std::size_t peak_memory_bytes();

}  // namespace prt
