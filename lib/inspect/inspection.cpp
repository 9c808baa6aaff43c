#include "inspect/inspection.h"

#include <algorithm>
#include <fstream>
#include <string_view>

#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"

namespace prt::inspect {

namespace {

// Holds the channels of any transfer file, 36 bytes each, and the attributes after them.
constexpr std::size_t kHeadBytes = 1 << 20;

std::string read_head(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) {
    throw_bad_input("no such file", {.file = path.string()});
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw_bad_input("cannot open the file", {.file = path.string()});
  std::string head(kHeadBytes, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head;
}

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

// Both kinds of JSON file are objects; only glTF has to have "asset".
std::string kind_of_json(const std::filesystem::path& path, std::string_view head) {
  return lower_extension(path) == ".gltf" || contains(head, "\"asset\"") ? "model" : "light";
}

std::string kind_of(const std::filesystem::path& path) {
  const std::string head = read_head(path);
  const std::string_view text(head);
  if (text.starts_with("glTF")) return "model";
  if (text.starts_with("\x76\x2f\x31\x01")) {
    return contains(text, "prtkit_") ? "transfer" : "image";
  }
  for (const std::string_view magic : {"#?", "\x89PNG", "\xff\xd8\xff"}) {
    if (text.starts_with(magic)) return "image";
  }
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first != text.npos && text[first] == '{') return kind_of_json(path, text);
  if (text.starts_with("PK\x03\x04")) {
    throw_bad_input("arrays of NumPy's, or another ZIP archive, which are not inspected",
                    {.file = path.string(),
                     .advice = "numpy.load reads what prt-compress --signal writes, and its "
                               "--report has the figures."});
  }
  throw_bad_input("unknown kind of file",
                  {.file = path.string(),
                   .expected = "glTF, OpenEXR, Radiance HDR, PNG, JPEG, or a light of prt-light"});
}

Json findings_to_json(const std::vector<Finding>& findings) {
  Json list = Json::array();
  for (const Finding& finding : findings) {
    list.push_back({{"severity", finding.severity == Severity::error ? "error" : "warning"},
                    {"element", finding.element},
                    {"message", finding.message}});
  }
  return list;
}

}  // namespace

bool Inspection::valid() const {
  return std::none_of(findings.begin(), findings.end(),
                      [](const Finding& f) { return f.severity == Severity::error; });
}

Inspection inspect_file(const std::filesystem::path& path) {
  Inspection inspection;
  const std::string kind = kind_of(path);
  Json& json = inspection.json;
  json["file"] = path.string();
  json["bytes"] = std::filesystem::file_size(path);
  json["hash"] = hash_file(path);
  json["kind"] = kind;
  json["valid"] = true;  // here for the order of the keys
  json["findings"] = Json::array();
  try {
    if (kind == "model") inspect_model(path, inspection);
    if (kind == "transfer") inspect_transfer(path, inspection);
    if (kind == "light") inspect_light(path, inspection);
    if (kind == "image") inspect_image(path, inspection);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::bad_input) throw;
    inspection.error(error.details().element, error.what());
  }
  json["valid"] = inspection.valid();
  json["findings"] = findings_to_json(inspection.findings);
  return inspection;
}

void check_compressed(const Json& result) {
  if (result.contains("precomputed_transfer")) return;
  throw_bad_input("holds no compressed transfer",
                  {.file = result["file"],
                   .found = result["kind"].get<std::string>() == "model"
                                ? "a model alone"
                                : "a file of kind " + result["kind"].get<std::string>(),
                   .expected = "a model that prt-compress has written"});
}

}  // namespace prt::inspect
