// OFF, NOFF, COFF, STOFF in text. Lines may end in comments.
#include <limits>

#include "core/error.h"
#include "mesh/mesh_file.h"
#include "mesh/text.h"

namespace prt::mesh {

namespace {

class OffReader {
 public:
  OffReader(std::string_view text, const std::filesystem::path& path)
      : lines_(text), size_(text.size()), path_(path) {}

  TriangleMesh read() {
    const std::string_view magic = next_word();
    if (!magic.ends_with("OFF") || magic.size() > 6) {
      reject("not an OFF file", magic, "the first word \"OFF\"");
    }
    // Prefixes stand in this order: texture coordinates, colour, normal; 4 and n are other spaces.
    const bool has_texcoords = magic.starts_with("ST"), has_normals = magic.ends_with("NOFF");
    if (magic.find_first_of("4n") != magic.npos) reject("vertices that are not 3D", magic, "OFF");
    const std::size_t vertex_count = read_count(6), face_count = read_count(4);
    read_count(0);  // edges, of no use
    for (std::size_t i = 0; i < vertex_count; ++i) {
      mesh_.positions.push_back(read_vec3());
      if (has_normals) mesh_.normals.push_back(read_vec3());
      line_ = has_texcoords ? last_words(2) : std::string_view();  // skips a colour
      if (has_texcoords) {
        const float u = read_float();
        mesh_.texcoords.emplace_back(u, 1.0f - read_float());
      }
    }
    for (std::size_t i = 0; i < face_count; ++i) read_face(vertex_count);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void reject(const std::string& what, std::string_view found,
                           const std::string& expected) const {
    throw_bad_input(what, {.file = path_.string(),
                           .element = "line " + std::to_string(lines_.line_number()),
                           .found = excerpt(found),
                           .expected = expected});
  }

  std::string_view next_word() {
    for (;;) {
      const std::string_view word = take_word(line_);
      if (!word.empty()) return word;
      const auto line = lines_.next();
      if (!line) reject("the file is truncated", "", "more elements, as the header says");
      line_ = line->substr(0, line->find('#'));
    }
  }

  // The rest of the line may hold a colour of any length before the texture coordinates.
  std::string_view last_words(int count) const {
    std::string_view rest = trimmed(line_);
    std::size_t begin = rest.size();
    for (int i = 0; i < count && begin != 0; ++i) {
      const std::size_t space = rest.find_last_of(" \t", begin - 1);
      begin = space == rest.npos ? 0 : space;
    }
    return rest.substr(begin);
  }

  float read_float() {
    const std::string_view word = next_word();
    const auto value = to_float(word);
    if (!value) reject("bad number", word, "a number");
    return *value;
  }

  Vec3 read_vec3() {
    const float x = read_float(), y = read_float();
    return {x, y, read_float()};
  }

  // Each element takes at least `bytes_each` of the file.
  std::size_t read_count(std::size_t bytes_each) {
    const std::string_view word = next_word();
    const auto value = to_integer(word);
    const bool fits = value && *value >= 0 &&
                      (bytes_each == 0 || static_cast<std::size_t>(*value) <= size_ / bytes_each);
    if (!fits || *value >= std::numeric_limits<std::uint32_t>::max()) {
      reject("bad count", word, "no more elements than the file has room for");
    }
    return static_cast<std::size_t>(*value);
  }

  void read_face(std::size_t vertex_count) {
    const std::size_t count = read_count(2);
    std::array<std::uint32_t, 3> fan{};
    for (std::size_t k = 0; k < count; ++k) {
      const std::string_view word = next_word();
      const auto index = to_integer(word);
      if (!index || *index < 0 || static_cast<std::size_t>(*index) >= vertex_count) {
        reject("vertex index past the end", word, "less than " + std::to_string(vertex_count));
      }
      fan[k < 2 ? k : 2] = static_cast<std::uint32_t>(*index);
      if (k < 2) continue;
      mesh_.indices.insert(mesh_.indices.end(), fan.begin(), fan.end());
      fan[1] = fan[2];
    }
    line_ = {};  // a face's colour
  }

  LineReader lines_;
  std::size_t size_;
  const std::filesystem::path& path_;
  std::string_view line_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_off(std::string_view text, const std::filesystem::path& path) {
  return OffReader(text, path).read();
}

}  // namespace prt::mesh
