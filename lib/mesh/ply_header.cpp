#include "mesh/ply_header.h"

#include "core/error.h"
#include "mesh/text.h"

namespace prt::mesh {

namespace {

class HeaderReader {
 public:
  HeaderReader(std::string_view& rest, const std::filesystem::path& path)
      : rest_(rest), path_(path) {}

  PlyHeader read() {
    read_lines();
    return std::move(header_);
  }

 private:
  [[noreturn]] void reject(const std::string& what, const std::string& element = {},
                           const std::string& found = {}, const std::string& expected = {}) const {
    throw_bad_input(
        what, {.file = path_.string(), .element = element, .found = found, .expected = expected});
  }

  std::string_view header_line() {
    const std::size_t end = rest_.find('\n');
    if (end == rest_.npos) reject("PLY header has no end_header: the file is truncated");
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  void read_lines() {
    if (!rest_.starts_with("ply\n") && !rest_.starts_with("ply\r\n")) {
      reject("not a PLY file", {}, excerpt(rest_.substr(0, 4)), "the first line \"ply\"");
    }
    for (std::string_view line = header_line();;) {
      line = header_line();
      const std::string_view key = take_word(line);
      if (key == "end_header") return;
      if (key == "format") {
        read_format(take_word(line));
      } else if (key == "element") {
        const std::string name(take_word(line));
        const auto count = to_integer(take_word(line));
        if (!count || *count < 0) reject("bad element count", "element " + excerpt(name));
        header_.elements.push_back({name, static_cast<std::size_t>(*count), {}});
      } else if (key == "property") {
        if (header_.elements.empty()) reject("property before any element", "header");
        header_.elements.back().properties.push_back(read_property(line));
      }
    }
  }

  void read_format(std::string_view word) {
    if (word == "ascii") {
      header_.format = PlyFormat::ascii;
    } else if (word == "binary_little_endian") {
      header_.format = PlyFormat::little_endian;
    } else if (word == "binary_big_endian") {
      header_.format = PlyFormat::big_endian;
    } else {
      reject("unknown PLY format", "header", excerpt(word),
             "ascii, binary_little_endian or binary_big_endian");
    }
  }

  PlyType read_type(std::string_view word) const {
    constexpr std::pair<const char*, PlyType> kTypes[] = {
        {"char", PlyType::i8},    {"int8", PlyType::i8},     {"uchar", PlyType::u8},
        {"uint8", PlyType::u8},   {"short", PlyType::i16},   {"int16", PlyType::i16},
        {"ushort", PlyType::u16}, {"uint16", PlyType::u16},  {"int", PlyType::i32},
        {"int32", PlyType::i32},  {"uint", PlyType::u32},    {"uint32", PlyType::u32},
        {"float", PlyType::f32},  {"float32", PlyType::f32}, {"double", PlyType::f64},
        {"float64", PlyType::f64}};
    for (const auto& [name, type] : kTypes) {
      if (word == name) return type;
    }
    reject("unknown property type", "header", excerpt(word), "one of PLY's types");
  }

  PlyProperty read_property(std::string_view line) const {
    const std::string_view word = take_word(line);
    PlyProperty property;
    property.is_list = word == "list";
    if (property.is_list) {
      property.count_type = read_type(take_word(line));
      property.type = read_type(take_word(line));
    } else {
      property.type = read_type(word);
    }
    property.name = take_word(line);
    return property;
  }

  std::string_view& rest_;
  const std::filesystem::path& path_;
  PlyHeader header_;
};

}  // namespace

PlyHeader take_ply_header(std::string_view& rest, const std::filesystem::path& path) {
  return HeaderReader(rest, path).read();
}

}  // namespace prt::mesh
