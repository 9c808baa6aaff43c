#include "core/file.h"

#include <fmt/format.h>

#include <fstream>

#include "core/error.h"

namespace prt {

namespace {

template <class Container>
Container read_whole(const std::filesystem::path& path, std::size_t limit) {
  check_input(path);
  const std::uintmax_t size = std::filesystem::file_size(path);
  if (size > limit) {
    throw_bad_input("file too large", {.file = path.string(),
                                       .found = fmt::format("{} bytes", size),
                                       .expected = fmt::format("at most {} bytes", limit)});
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw_bad_input("cannot open the file", {.file = path.string()});
  Container content(static_cast<std::size_t>(size), typename Container::value_type{});
  file.read(reinterpret_cast<char*>(content.data()), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(file.gcount()) != size) {
    throw_failed("reading failed", {.file = path.string()});
  }
  return content;
}

}  // namespace

void check_input(const std::filesystem::path& path) {
  std::error_code code;
  const auto status = std::filesystem::status(path, code);
  if (!std::filesystem::exists(status)) throw_bad_input("no such file", {.file = path.string()});
  if (!std::filesystem::is_regular_file(status)) {
    throw_bad_input("not a regular file", {.file = path.string()});
  }
}

std::vector<std::byte> read_file(const std::filesystem::path& path, std::size_t limit) {
  return read_whole<std::vector<std::byte>>(path, limit);
}

std::string read_text_file(const std::filesystem::path& path, std::size_t limit) {
  return read_whole<std::string>(path, limit);
}

std::string lower_extension(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : ".";
}

}  // namespace prt
