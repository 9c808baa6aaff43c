// What is in a file, and whether it is valid: the library behind prt-inspect. Results are JSON
// objects whose keys docs/tools/prt-inspect.md documents.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace prt::inspect {

using Json = nlohmann::ordered_json;

/// Errors make a file invalid; warnings are worth knowing.
enum class Severity { warning, error };

struct Finding {
  Severity severity;
  std::string element;  ///< "PRTKIT_precomputed_transfer", "cluster 7", …
  std::string message;
};

struct Inspection {
  Json json = Json::object();
  std::vector<Finding> findings;

  void error(std::string element, std::string message) {
    findings.push_back({Severity::error, std::move(element), std::move(message)});
  }
  void warning(std::string element, std::string message) {
    findings.push_back({Severity::warning, std::move(element), std::move(message)});
  }
  bool valid() const;
};

/// Looks into a model (.glb, .gltf), transfer (.transfer.exr), light (.json), environment map or
/// image, told apart by content. What is wrong inside is a finding; throws Error (bad_input) only
/// when the file cannot be read or is of no known kind. The JSON has file, bytes, hash, kind,
/// valid, findings, and one object named after the kind.
Inspection inspect_file(const std::filesystem::path& path);

/// The parts of it, for a file of known kind: each adds its object and its findings.
void inspect_model(const std::filesystem::path& path, Inspection& inspection);
void inspect_transfer(const std::filesystem::path& path, Inspection& inspection);
void inspect_light(const std::filesystem::path& path, Inspection& inspection);
void inspect_image(const std::filesystem::path& path, Inspection& inspection);

/// Throws Error (bad_input) unless the result is that of a model with compressed transfer.
void check_compressed(const Json& result);

/// JSON for people: aligned names and values, lists of objects as tables.
std::string to_text(const Json& json);

}  // namespace prt::inspect
