// Stanford PLY, ASCII and binary of both byte orders. Read by hand because OpenMesh's reader
// believes the header's counts.
#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "core/error.h"
#include "image/srgb.h"
#include "mesh/mesh_file.h"
#include "mesh/ply_header.h"
#include "mesh/text.h"

namespace prt::mesh {

namespace {

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::i8:
    case PlyType::u8:
      return 1;
    case PlyType::i16:
    case PlyType::u16:
      return 2;
    case PlyType::f64:
      return 8;
    default:
      return 4;
  }
}

class PlyReader {
 public:
  PlyReader(std::string_view bytes, const std::filesystem::path& path)
      : rest_(bytes), path_(path) {}

  TriangleMesh read() {
    const PlyHeader header = take_ply_header(rest_, path_);
    format_ = header.format;
    for (const PlyElement& element : header.elements) {
      check_count(element);
      if (element.name == "vertex") {
        read_vertices(element);
      } else {
        read_others(element);
      }
    }
    check_indices();
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void reject(const std::string& what, const std::string& element = {},
                           const std::string& found = {}, const std::string& expected = {}) const {
    throw_bad_input(
        what, {.file = path_.string(), .element = element, .found = found, .expected = expected});
  }

  // Every property takes at least its binary size, or a digit and a separator, in what is left.
  void check_count(const PlyElement& element) const {
    std::size_t least = 0;
    for (const PlyProperty& property : element.properties) {
      const PlyType first = property.is_list ? property.count_type : property.type;
      least += format_ == PlyFormat::ascii ? 2 : size_of(first);
    }
    // The last separator of an ASCII file may be missing.
    if (least == 0 || element.count > (rest_.size() + 1) / least) {
      reject(
          "the file is too small for its header", "element " + excerpt(element.name),
          std::to_string(element.count) + " elements in " + std::to_string(rest_.size()) + " bytes",
          "at least " + std::to_string(least) + " bytes for each");
    }
    if (element.count >= std::numeric_limits<std::uint32_t>::max()) {
      reject("too many elements", "element " + excerpt(element.name), std::to_string(element.count),
             "fewer than 2^32 - 1");
    }
  }

  double read_ascii_number(const PlyElement& element, std::size_t i) {
    std::size_t begin = 0;
    while (begin < rest_.size() && static_cast<unsigned char>(rest_[begin]) <= ' ') ++begin;
    std::size_t end = begin;
    while (end < rest_.size() && static_cast<unsigned char>(rest_[end]) > ' ') ++end;
    const std::string_view word = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    if (const auto integer = to_integer(word)) return static_cast<double>(*integer);
    const auto value = to_float(word);
    if (!value) {
      reject(word.empty() ? "the file is truncated" : "bad number", label(element, i),
             excerpt(word), "a number");
    }
    return *value;
  }

  template <class T>
  double take_binary() {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), rest_.data(), sizeof(T));
    rest_.remove_prefix(sizeof(T));
    if (format_ == PlyFormat::big_endian) std::reverse(bytes.begin(), bytes.end());
    return static_cast<double>(std::bit_cast<T>(bytes));
  }

  double read_number(PlyType type, const PlyElement& element, std::size_t i) {
    if (format_ == PlyFormat::ascii) return read_ascii_number(element, i);
    if (rest_.size() < size_of(type)) reject("the file is truncated", label(element, i));
    switch (type) {
      case PlyType::i8:
        return take_binary<std::int8_t>();
      case PlyType::u8:
        return take_binary<std::uint8_t>();
      case PlyType::i16:
        return take_binary<std::int16_t>();
      case PlyType::u16:
        return take_binary<std::uint16_t>();
      case PlyType::i32:
        return take_binary<std::int32_t>();
      case PlyType::u32:
        return take_binary<std::uint32_t>();
      case PlyType::f32:
        return take_binary<float>();
      default:
        return take_binary<double>();
    }
  }

  static std::string label(const PlyElement& element, std::size_t i) {
    return element.name + " " + std::to_string(i);
  }

  std::size_t read_list_count(const PlyProperty& property, const PlyElement& element,
                              std::size_t i) {
    const double count = read_number(property.count_type, element, i);
    const std::size_t least = format_ == PlyFormat::ascii ? 2 : size_of(property.type);
    if (!(count >= 0.0) || count > static_cast<double>((rest_.size() + 1) / least)) {
      reject("the file is truncated", label(element, i), std::to_string(count) + " list entries");
    }
    return static_cast<std::size_t>(count);
  }

  void read_vertices(const PlyElement& element) {
    // Another one might have other properties: attributes would be of different lengths.
    if (mesh_.vertex_count() > 0) reject("a second element vertex", "header");
    const auto column = [&](const char* name) {
      const auto found = std::find_if(element.properties.begin(), element.properties.end(),
                                      [&](const PlyProperty& p) { return p.name == name; });
      return static_cast<std::size_t>(found - element.properties.begin());
    };
    const std::size_t none = element.properties.size();
    const auto has = [&](std::initializer_list<const char*> names) {
      return std::all_of(names.begin(), names.end(), [&](auto n) { return column(n) != none; });
    };
    if (!has({"x", "y", "z"})) reject("vertices without x, y, z", "header");
    const bool normals = has({"nx", "ny", "nz"}), colors = has({"red", "green", "blue"});
    const char* u = has({"s", "t"}) ? "s" : "u";
    const char* v = has({"s", "t"}) ? "t" : "v";
    const bool texcoords = has({u, v});
    std::vector<float> row(none);
    const auto at = [&](const char* name) { return row[column(name)]; };
    const auto color_at = [&](const char* name) {
      const PlyType type = element.properties[column(name)].type;
      return type == PlyType::u8    ? image::linear_from_srgb(at(name) / 255.0f)
             : type == PlyType::u16 ? at(name) / 65535.0f
                                    : at(name);
    };
    for (std::size_t i = 0; i < element.count; ++i) {
      read_row(element, i, row);
      mesh_.positions.emplace_back(at("x"), at("y"), at("z"));
      if (normals) mesh_.normals.emplace_back(at("nx"), at("ny"), at("nz"));
      if (texcoords) mesh_.texcoords.emplace_back(at(u), 1.0f - at(v));
      if (colors) {
        mesh_.colors.emplace_back(color_at("red"), color_at("green"), color_at("blue"), 1.0f);
      }
    }
  }

  void read_row(const PlyElement& element, std::size_t i, std::vector<float>& row) {
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (!property.is_list) {
        row[p] = narrowed(read_number(property.type, element, i));
        continue;
      }
      for (std::size_t n = read_list_count(property, element, i); n > 0; --n) {
        read_number(property.type, element, i);
      }
    }
  }

  void read_others(const PlyElement& element) {
    for (std::size_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties) {
        const bool is_face = property.is_list && element.name == "face" &&
                             (property.name == "vertex_indices" || property.name == "vertex_index");
        if (is_face) {
          read_face(property, element, i);
          continue;
        }
        std::size_t n = property.is_list ? read_list_count(property, element, i) : 1;
        for (; n > 0; --n) read_number(property.type, element, i);
      }
    }
  }

  void read_face(const PlyProperty& property, const PlyElement& element, std::size_t i) {
    const std::size_t count = read_list_count(property, element, i);
    std::array<std::uint32_t, 3> fan{};
    for (std::size_t k = 0; k < count; ++k) {
      const double index = read_number(property.type, element, i);
      if (!(index >= 0.0 && index < std::numeric_limits<std::uint32_t>::max())) {
        reject("bad vertex index", label(element, i), std::to_string(index));
      }
      fan[std::min<std::size_t>(k, 2)] = static_cast<std::uint32_t>(index);
      if (k < 2) continue;
      mesh_.indices.insert(mesh_.indices.end(), fan.begin(), fan.end());
      fan[1] = fan[2];
    }
  }

  void check_indices() const {
    for (std::size_t i = 0; i < mesh_.indices.size(); ++i) {
      if (mesh_.indices[i] < mesh_.vertex_count()) continue;
      reject("vertex index past the end", "triangle " + std::to_string(i / 3),
             std::to_string(mesh_.indices[i]), "less than " + std::to_string(mesh_.vertex_count()));
    }
  }

  std::string_view rest_;
  const std::filesystem::path& path_;
  PlyFormat format_ = PlyFormat::ascii;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_ply(std::string_view bytes, const std::filesystem::path& path) {
  return PlyReader(bytes, path).read();
}

}  // namespace prt::mesh
