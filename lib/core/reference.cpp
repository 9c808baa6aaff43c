#include "core/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string>

#include "core/error.h"

namespace prt {

namespace {

std::string decode_percent(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned value = 0;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(&text[i + 1], &text[i + 1] + 2, value, 16).ptr == &text[i + 1] + 2) {
      decoded += static_cast<char>(value);
      i += 2;
    } else {
      decoded += text[i];
    }
  }
  return decoded;
}

bool has_scheme(std::string_view name) {
  const std::size_t colon = name.find(':');
  if (colon == std::string_view::npos || colon == 0) return false;
  return std::all_of(name.begin(), name.begin() + static_cast<std::ptrdiff_t>(colon), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '+' ||
           c == '-' || c == '.';
  });
}

/// With links followed; empty when that fails.
std::filesystem::path real_path(const std::filesystem::path& path) {
  std::error_code error;
  // weakly_canonical leaves a relative path relative where its first part does not exist.
  const auto absolute = std::filesystem::absolute(path.empty() ? "." : path, error);
  if (error) return {};
  const auto real = std::filesystem::weakly_canonical(absolute, error);
  return error ? std::filesystem::path() : real;
}

bool is_inside(const std::filesystem::path& path, const std::filesystem::path& folder) {
  return !path.empty() && !folder.empty() &&
         std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
             folder.end();
}

}  // namespace

std::filesystem::path resolve_reference(const std::filesystem::path& file,
                                        std::string_view reference, Escapes escapes) {
  std::string name =
      escapes == Escapes::percent ? decode_percent(reference) : std::string(reference);
  const std::string found = fmt::format("\"{}\"", reference.substr(0, 100));
  const auto reject = [&](const char* why) {
    throw_bad_input(why, {.file = file.string(),
                          .element = "reference to another file",
                          .found = found,
                          .expected = "a relative path inside the file's own folder"});
  };
  std::replace(name.begin(), name.end(), '\\', '/');
  if (name.empty()) reject("empty name");
  if (name.find('\0') != std::string::npos) reject("name with a zero byte");
  if (name.front() == '/') reject("absolute path");
  if (has_scheme(name)) reject("name with a scheme");
  const std::filesystem::path path(name);
  if (std::find(path.begin(), path.end(), "..") != path.end()) reject("path with \"..\"");
  const std::filesystem::path target = real_path(file.parent_path() / path);
  if (!is_inside(target, real_path(file.parent_path()))) reject("link out of the folder");
  return target;
}

}  // namespace prt
