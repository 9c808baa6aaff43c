#include "signal/npy.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>

#include "core/checked.h"
#include "core/file.h"

namespace prt::signal {

namespace {

constexpr std::size_t kMaxHeader = 1 << 16;

struct Header {
  std::size_t value_size;  ///< 4 or 8 bytes
  std::size_t row_count, column_count;
  std::size_t data_offset;
};

[[noreturn]] void refuse(const std::string& what, std::string found, std::string expected) {
  throw_bad_input(what, {.found = std::move(found), .expected = std::move(expected)});
}

/// What stands behind 'key': in the header's dictionary.
std::string_view value_of(std::string_view dictionary, std::string_view key) {
  const std::string quoted = fmt::format("'{}'", key);
  std::size_t at = dictionary.find(quoted);
  if (at != std::string_view::npos) at = dictionary.find(':', at + quoted.size());
  if (at != std::string_view::npos) at = dictionary.find_first_not_of(' ', at + 1);
  if (at == std::string_view::npos) refuse("broken header", fmt::format("no {}", quoted), "one");
  return dictionary.substr(at);
}

std::size_t value_size(std::string_view type) {
  if (type.starts_with("'<f4'")) return 4;
  if (type.starts_with("'<f8'")) return 8;
  refuse("values of another type", std::string(type.substr(0, type.find(','))),
         "'<f4' or '<f8' (float32 or float64, little-endian)");
}

/// The sizes in "(3, 4)".
std::vector<std::size_t> parse_shape(std::string_view text) {
  std::vector<std::size_t> sizes;
  const std::size_t end = text.find(')');
  if (!text.starts_with('(') || end == std::string_view::npos) {
    refuse("broken header", "a shape that is no list", "'shape': (rows, columns)");
  }
  const char *next = text.data() + 1, *last = text.data() + end;
  while (true) {
    while (next != last && (*next == ' ' || *next == ',')) ++next;
    if (next == last) return sizes;
    std::size_t size = 0;
    const auto [stop, code] = std::from_chars(next, last, size);
    if (code != std::errc() || sizes.size() == 2) {
      refuse("not a matrix", std::string(text.substr(0, std::min(end + 1, std::size_t{80}))),
             "a shape of one or two sizes");
    }
    sizes.push_back(size);
    next = stop;
  }
}

Header parse_dictionary(std::string_view dictionary) {
  Header header{};
  header.value_size = value_size(value_of(dictionary, "descr"));
  if (!value_of(dictionary, "fortran_order").starts_with("False")) {
    refuse("values column by column", "'fortran_order': True", "C order");
  }
  std::vector<std::size_t> shape = parse_shape(value_of(dictionary, "shape"));
  if (shape.size() == 1) shape.push_back(1);
  if (shape.size() != 2 || shape[0] == 0 || shape[1] == 0) {
    refuse("no values", "an empty shape", "at least one row and one column");
  }
  header.row_count = shape[0];
  header.column_count = shape[1];
  return header;
}

std::string read_bytes(std::ifstream& file, std::size_t count) {
  std::string bytes(count, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(count));
  if (static_cast<std::size_t>(file.gcount()) != count) {
    refuse("header cut off", fmt::format("{} bytes", file.gcount()), fmt::format("{}", count));
  }
  return bytes;
}

Header read_header(std::ifstream& file) {
  const std::string start = read_bytes(file, 8);
  if (!start.starts_with("\x93NUMPY")) refuse("not a .npy file", "another start", "\\x93NUMPY");
  const int version = start[6];
  if (version < 1 || version > 3) {
    refuse("unknown version", std::to_string(version), "1, 2 or 3");
  }
  const std::size_t length_size = version == 1 ? 2 : 4;
  std::size_t length = 0;
  const std::string bytes = read_bytes(file, length_size);
  for (std::size_t i = length_size; i-- > 0;) {
    length = length << 8 | static_cast<unsigned char>(bytes[i]);
  }
  if (length > kMaxHeader) {
    refuse("header too long", fmt::format("{} bytes", length), fmt::format("up to {}", kMaxHeader));
  }
  Header header = parse_dictionary(read_bytes(file, length));
  header.data_offset = 8 + length_size + length;
  return header;
}

void check_sizes(const Header& header, std::size_t file_size, std::size_t max_bytes) {
  const std::size_t count = checked_multiply(header.row_count, header.column_count);
  const std::size_t data_size = checked_multiply(count, header.value_size);
  if (checked_add(header.data_offset, data_size) != file_size) {
    refuse("file of another length",
           fmt::format("{} bytes of values", file_size - std::min(file_size, header.data_offset)),
           fmt::format("{} for {} × {}", data_size, header.row_count, header.column_count));
  }
  if (count * sizeof(float) > max_bytes) {
    throw_bad_input("too large",
                    {.found = fmt::format("{} × {} values, {} bytes of memory", header.row_count,
                                          header.column_count, count * sizeof(float)),
                     .expected = fmt::format("at most {} bytes", max_bytes),
                     .advice = "Take fewer rows or columns, or a machine of more memory."});
  }
}

[[noreturn]] void refuse_value(const Header& header, std::size_t index, double value) {
  throw_bad_input(std::isfinite(value) ? "beyond the range of float" : "not a finite number",
                  {.element = fmt::format("row {}, column {}", index / header.column_count,
                                          index % header.column_count),
                   .found = fmt::format("{}", value),
                   .expected = fmt::format("up to {:.2g}", std::numeric_limits<float>::max())});
}

void read_doubles(std::ifstream& file, const Header& header, std::vector<float>& values) {
  std::array<double, 4096> some;
  for (std::size_t done = 0; done < values.size(); done += some.size()) {
    const std::size_t count = std::min(some.size(), values.size() - done);
    file.read(reinterpret_cast<char*>(some.data()),
              static_cast<std::streamsize>(count * sizeof(double)));
    for (std::size_t i = 0; file && i < count; ++i) {
      if (!(std::abs(some[i]) <= double{std::numeric_limits<float>::max()})) {
        refuse_value(header, done + i, some[i]);
      }
      values[done + i] = static_cast<float>(some[i]);
    }
  }
}

}  // namespace

Matrix read_npy(const std::filesystem::path& path, std::size_t max_bytes) {
  check_input(path);
  std::ifstream file(path, std::ios::binary);
  if (!file) throw_bad_input("cannot open the file", {.file = path.string()});
  try {
    const Header header = read_header(file);
    check_sizes(header, std::filesystem::file_size(path), max_bytes);
    Matrix matrix{.values = std::vector<float>(header.row_count * header.column_count),
                  .row_count = header.row_count,
                  .column_count = header.column_count};
    if (header.value_size == sizeof(double)) {
      read_doubles(file, header, matrix.values);
    } else {
      file.read(reinterpret_cast<char*>(matrix.values.data()),
                static_cast<std::streamsize>(matrix.values.size() * sizeof(float)));
    }
    if (!file) throw_failed("reading failed", {.file = path.string()});
    const auto bad = std::find_if(matrix.values.begin(), matrix.values.end(),
                                  [](float value) { return !std::isfinite(value); });
    if (bad != matrix.values.end()) {
      refuse_value(header, static_cast<std::size_t>(bad - matrix.values.begin()), double{*bad});
    }
    return matrix;
  } catch (const Error& error) {
    if (!error.details().file.empty()) throw;
    throw Error(error.kind(), fmt::format("{}: {}", path.string(), error.what()));
  }
}

}  // namespace prt::signal
