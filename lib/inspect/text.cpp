#include <fmt/format.h>

#include <algorithm>

#include "inspect/inspection.h"

namespace prt::inspect {

namespace {

bool is_table(const Json& json) {
  return json.is_array() && !json.empty() &&
         std::all_of(json.begin(), json.end(), [](const Json& row) { return row.is_object(); });
}

std::string scalar(const Json& json) {
  if (json.is_string()) return json.get<std::string>();
  if (json.is_boolean()) return json.get<bool>() ? "yes" : "no";
  if (json.is_number_float()) return fmt::format("{:.6g}", json.get<double>());
  if (!json.is_structured()) return json.dump();
  std::string text;
  for (const auto& [key, value] : json.items()) {
    if (!text.empty()) text += json.is_object() ? ", " : " ";
    if (json.is_object()) text += key + " ";
    text += scalar(value);
  }
  return text.empty() ? "none" : text;
}

void append_table(const Json& rows, const std::string& indent, std::string& text) {
  std::vector<std::string> names;
  for (const Json& row : rows) {
    for (const auto& [key, value] : row.items()) {
      if (std::find(names.begin(), names.end(), key) == names.end()) names.push_back(key);
    }
  }
  std::vector<std::vector<std::string>> cells{names};
  for (const Json& row : rows) {
    cells.emplace_back();
    for (const std::string& name : names) {
      cells.back().push_back(row.contains(name) ? scalar(row[name]) : "");
    }
  }
  std::vector<std::size_t> widths(names.size());
  for (const auto& row : cells) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  for (const auto& row : cells) {
    std::string line = indent;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += fmt::format("{:<{}}", row[i], widths[i] + 2);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
}

// Objects of scalars fit a line; larger ones get a heading.
bool fits_a_line(const Json& json) {
  if (!json.is_structured()) return true;
  if (is_table(json)) return false;
  return json.size() <= 6 && std::all_of(json.begin(), json.end(),
                                         [](const Json& value) { return !value.is_structured(); });
}

void append(const Json& object, const std::string& indent, std::string& text) {
  std::size_t width = 0;
  for (const auto& [key, value] : object.items()) {
    if (fits_a_line(value) || value.is_array()) width = std::max(width, key.size());
  }
  for (const auto& [key, value] : object.items()) {
    if (is_table(value)) {
      text += indent + key + "\n";
      append_table(value, indent + "  ", text);
    } else if (fits_a_line(value) || value.is_array()) {
      text += fmt::format("{}{:<{}}  {}\n", indent, key, width, scalar(value));
    } else {
      text += indent + key + "\n";
      append(value, indent + "  ", text);
    }
  }
}

}  // namespace

std::string to_text(const Json& json) {
  std::string text;
  append(json, "", text);
  return text;
}

}  // namespace prt::inspect
