// What the header of a PLY file announces. Nothing in it is believed: see mesh/ply.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace prt::mesh {

enum class PlyFormat { ascii, little_endian, big_endian };
enum class PlyType { i8, u8, i16, u16, i32, u32, f32, f64 };

struct PlyProperty {
  std::string name;
  PlyType type;  ///< of the value, or of a list's entries
  bool is_list = false;
  PlyType count_type = PlyType::u8;  ///< of a list's length
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
};

/// Takes the header off the front of `rest`. Throws Error (bad_input).
PlyHeader take_ply_header(std::string_view& rest, const std::filesystem::path& path);

}  // namespace prt::mesh
