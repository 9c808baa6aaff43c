// STL, binary and text. Its facet normals are left alone: they follow from the corners.
#include <bit>
#include <cstring>

#include "core/error.h"
#include "mesh/mesh_file.h"
#include "mesh/text.h"

namespace prt::mesh {

namespace {

constexpr std::size_t kHeaderBytes = 84, kFacetBytes = 50;
static_assert(std::endian::native == std::endian::little, "binary STL is read as it stands");

std::size_t announced_bytes(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kHeaderBytes - sizeof(count), sizeof(count));
  return kHeaderBytes + std::size_t{count} * kFacetBytes;
}

void add_corner(TriangleMesh& mesh, const Vec3& position) {
  mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
  mesh.positions.push_back(position);
}

TriangleMesh read_binary(std::string_view bytes) {
  TriangleMesh mesh;
  for (std::size_t facet = kHeaderBytes; facet < bytes.size(); facet += kFacetBytes) {
    float corners[9];
    std::memcpy(corners, bytes.data() + facet + 3 * sizeof(float), sizeof(corners));
    for (int k = 0; k < 3; ++k) {
      add_corner(mesh, {corners[3 * k], corners[3 * k + 1], corners[3 * k + 2]});
    }
  }
  return mesh;
}

TriangleMesh read_text(std::string_view text, const std::filesystem::path& path) {
  TriangleMesh mesh;
  LineReader lines(text);
  const auto reject = [&](const std::string& what, std::string_view found) {
    throw_bad_input(what, {.file = path.string(),
                           .element = "line " + std::to_string(lines.line_number()),
                           .found = excerpt(found)});
  };
  bool ended = false;
  while (auto line = lines.next()) {
    const std::string_view key = take_word(*line);
    ended |= key == "endsolid";
    if (key == "endloop" && mesh.positions.size() % 3 != 0) {
      reject("a facet that is no triangle", key);
    }
    if (key != "vertex") continue;
    Vec3 position;
    for (int c = 0; c < 3; ++c) {
      const std::string_view word = take_word(*line);
      const auto value = to_float(word);
      if (!value) reject("bad vertex", word);
      position[c] = *value;
    }
    add_corner(mesh, position);
  }
  if (!ended) reject("the file is truncated: no endsolid", "");
  if (mesh.positions.size() % 3 != 0) reject("a facet that is no triangle", "");
  return mesh;
}

}  // namespace

TriangleMesh read_stl(std::string_view bytes, const std::filesystem::path& path) {
  // Binary headers, too, may begin with "solid": the size decides.
  if (bytes.size() >= kHeaderBytes && announced_bytes(bytes) == bytes.size()) {
    return read_binary(bytes);
  }
  if (bytes.starts_with("solid")) return read_text(bytes, path);
  throw_bad_input(
      "not an STL file, or truncated",
      {.file = path.string(),
       .found = std::to_string(bytes.size()) + " bytes",
       .expected = bytes.size() < kHeaderBytes ? "at least 84 bytes"
                                               : std::to_string(announced_bytes(bytes)) +
                                                     " bytes, as its header says, or text"});
}

}  // namespace prt::mesh
