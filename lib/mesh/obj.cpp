// Wavefront OBJ. Read by hand because OpenMesh's reader trusts indices; ours checks each against
// what the file really has.
#include <array>
#include <limits>
#include <map>
#include <unordered_map>

#include "core/error.h"
#include "core/log.h"
#include "mesh/mesh_file.h"
#include "mesh/mtl.h"
#include "mesh/text.h"

namespace prt::mesh {

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// Numbers of position, texture coordinate and normal; kNone where absent.
using Corner = std::array<std::uint32_t, 3>;

struct CornerHash {
  std::size_t operator()(const Corner& corner) const {
    std::uint64_t hash = 0;
    for (const std::uint32_t part : corner) hash = (hash ^ part) * 0x9e3779b97f4a7c15ull;
    return hash ^ (hash >> 32);
  }
};

// The triangles of one material, as corners; vertices are made once all of the file is known.
struct Group {
  int material = -1;
  std::string name;
  std::vector<Corner> corners;     // three a triangle
  std::vector<std::size_t> lines;  // one a triangle, for messages
};

class ObjReader {
 public:
  ObjReader(const std::filesystem::path& path, const ReadLimits& limits)
      : path_(path), limits_(limits) {}

  Scene read(std::string_view text) {
    LineReader lines(text);
    while (auto line = lines.next()) {
      line_number_ = lines.line_number();
      if (line->ends_with('\\')) {
        joined_ += std::string(line->substr(0, line->size() - 1)) + ' ';
      } else if (joined_.empty()) {
        read_line(*line);
      } else {
        read_line(joined_ += *line);
        joined_.clear();
      }
    }
    is_used_.resize(positions_.size());
    for (const Group& group : groups_) {
      if (!group.corners.empty()) add_primitive(group);
    }
    if (!scene_.primitives.empty()) append_unused_vertices(scene_.primitives[0].mesh);
    return std::move(scene_);
  }

 private:
  [[noreturn]] void reject(std::size_t line, const std::string& what, std::string_view found,
                           const std::string& expected) const {
    throw_bad_input(what, {.file = path_.string(),
                           .element = "line " + std::to_string(line),
                           .found = excerpt(found),
                           .expected = expected});
  }

  void read_line(std::string_view line) {
    line = line.substr(0, line.find('#'));
    const std::string_view key = take_word(line);
    if (key == "v") {
      positions_.push_back(read_vector<Vec3>(line));
    } else if (key == "vt") {
      const Vec2 t = read_vector<Vec2>(line);
      texcoords_.emplace_back(t.x, 1.0f - t.y);  // OBJ's origin is the lower left
    } else if (key == "vn") {
      normals_.push_back(read_vector<Vec3>(line));
    } else if (key == "f") {
      read_face(line);
    } else if (key == "usemtl") {
      use_material(std::string(trimmed(line)));
    } else if (key == "mtllib") {
      read_material_library(path_, trimmed(line), limits_, scene_, materials_);
    }
  }

  template <class Vec>
  Vec read_vector(std::string_view line) {
    Vec vector(0.0f);
    for (unsigned c = 0; c < Vec::dimensions(); ++c) {
      const std::string_view word = take_word(line);
      if (word.empty() && Vec::dimensions() == 2 && c == 1) break;  // a one-dimensional texture
      const auto value = to_float(word);
      if (!value) reject(line_number_, "bad vertex", word, "a number");
      vector[static_cast<int>(c)] = *value;
    }
    return vector;
  }

  // One part of "v/vt/vn": negative numbers count back from the latest.
  std::uint32_t read_index(std::string_view word, std::size_t count) {
    const auto value = to_integer(word);
    if (!value || *value == 0) reject(line_number_, "bad index", word, "an integer, not 0");
    const long long index = *value > 0 ? *value - 1 : static_cast<long long>(count) + *value;
    if (index < 0 || index >= static_cast<long long>(kNone)) {
      reject(line_number_, "index out of range", word,
             "at most " + std::to_string(count) + " back");
    }
    return static_cast<std::uint32_t>(index);
  }

  Corner read_corner(std::string_view word) {
    const std::array<std::size_t, 3> counts{positions_.size(), texcoords_.size(), normals_.size()};
    Corner corner{kNone, kNone, kNone};
    std::string_view rest = word;
    for (std::size_t part = 0; part < 3; ++part) {
      const std::size_t slash = rest.find('/');
      const std::string_view number = rest.substr(0, slash);
      if (!number.empty()) corner[part] = read_index(number, counts[part]);
      if (slash == rest.npos) {
        rest = {};
        break;
      }
      rest.remove_prefix(slash + 1);
    }
    if (corner[0] == kNone || !rest.empty()) {
      reject(line_number_, "bad face corner", word, "v, v/vt, v//vn or v/vt/vn");
    }
    return corner;
  }

  void read_face(std::string_view line) {
    if (groups_.empty()) use_material("");
    Group& group = groups_[current_group_];
    std::vector<Corner> polygon;
    for (auto word = take_word(line); !word.empty(); word = take_word(line)) {
      polygon.push_back(read_corner(word));
    }
    if (polygon.size() < 3) {
      reject(line_number_, "bad face", std::to_string(polygon.size()) + " corners", "at least 3");
    }
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      group.corners.insert(group.corners.end(), {polygon[0], polygon[i - 1], polygon[i]});
      group.lines.push_back(line_number_);
    }
  }

  void use_material(const std::string& name) {
    const auto [group, added] = group_of_name_.try_emplace(name, groups_.size());
    current_group_ = group->second;
    if (!added) return;
    const auto material = materials_.find(name);
    if (material == materials_.end() && !name.empty()) {
      log::warning("{}: line {}: material {} is not defined, white instead", path_.string(),
                   line_number_, excerpt(name));
    }
    groups_.push_back({.material = material == materials_.end() ? -1 : material->second,
                       .name = name.empty() ? path_.stem().string() : name,
                       .corners = {},
                       .lines = {}});
  }

  void check_corner(const Group& group, std::size_t i) const {
    const std::array<std::size_t, 3> counts{positions_.size(), texcoords_.size(), normals_.size()};
    const char* names[3] = {"vertex", "texture coordinate", "normal"};
    for (std::size_t part = 0; part < 3; ++part) {
      const std::uint32_t index = group.corners[i][part];
      if (index == kNone || index < counts[part]) continue;
      reject(group.lines[i / 3], std::string(names[part]) + " index past the end",
             std::to_string(index + 1ull), "at most " + std::to_string(counts[part]));
    }
  }

  void add_primitive(const Group& group) {
    // An attribute that some corner lacks is left out, and computed if it can be.
    bool has_texcoords = true, has_normals = true;
    for (std::size_t i = 0; i < group.corners.size(); ++i) {
      check_corner(group, i);
      has_texcoords &= group.corners[i][1] != kNone;
      has_normals &= group.corners[i][2] != kNone;
    }
    TriangleMesh mesh;
    std::unordered_map<Corner, std::uint32_t, CornerHash> vertices;
    for (Corner corner : group.corners) {
      if (!has_texcoords) corner[1] = kNone;
      if (!has_normals) corner[2] = kNone;
      const auto [vertex, added] =
          vertices.try_emplace(corner, static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.indices.push_back(vertex->second);
      if (!added) continue;
      mesh.positions.push_back(positions_[corner[0]]);
      is_used_[corner[0]] = true;
      if (has_texcoords) mesh.texcoords.push_back(texcoords_[corner[1]]);
      if (has_normals) mesh.normals.push_back(normals_[corner[2]]);
    }
    scene_.primitives.push_back({.name = group.name,
                                 .mesh = std::move(mesh),
                                 .material = group.material,
                                 .mesh_index = static_cast<int>(scene_.primitives.size())});
  }

  // What no face uses is there all the same, for repair to drop and count.
  void append_unused_vertices(TriangleMesh& mesh) const {
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      if (!is_used_[i]) mesh.positions.push_back(positions_[i]);
    }
    if (!mesh.texcoords.empty()) mesh.texcoords.resize(mesh.vertex_count(), Vec2(0.0f));
    if (!mesh.normals.empty()) mesh.normals.resize(mesh.vertex_count(), Vec3(0.0f));
  }

  const std::filesystem::path& path_;
  const ReadLimits& limits_;
  std::size_t line_number_ = 0;
  std::string joined_;
  std::vector<Vec3> positions_, normals_;
  std::vector<Vec2> texcoords_;
  std::vector<bool> is_used_;  // of positions_, by a face
  std::vector<Group> groups_;
  std::map<std::string, std::size_t> group_of_name_;
  std::size_t current_group_ = 0;
  std::map<std::string, int> materials_;
  Scene scene_;
};

}  // namespace

Scene read_obj(std::string_view text, const std::filesystem::path& path, const ReadLimits& limits) {
  if (text.find('\0') != text.npos) {
    throw_bad_input("not an OBJ file: it is binary", {.file = path.string()});
  }
  return ObjReader(path, limits).read(text);
}

}  // namespace prt::mesh
