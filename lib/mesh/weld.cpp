#include "mesh/weld.h"

#include <string_view>
#include <unordered_map>

namespace prt::mesh {

namespace {

// A vertex as a row of floats; + 0.0f makes -0 a 0, so that equal rows are equal bytes.
template <class Vec>
void append(std::vector<float>& row, const std::vector<Vec>& values, std::size_t vertex) {
  if (values.empty()) return;
  for (unsigned c = 0; c < Vec::dimensions(); ++c) {
    row.push_back(values[vertex][static_cast<int>(c)] + 0.0f);
  }
}

template <class AppendRow>
std::vector<std::uint32_t> first_equal(std::size_t count, const AppendRow& append_row) {
  std::vector<float> rows, row;
  std::vector<std::uint32_t> first(count);
  if (count == 0) return first;
  append_row(row, 0);
  const std::size_t row_size = row.size();
  rows.reserve(count * row_size);
  for (std::size_t i = 0; i < count; ++i) append_row(rows, i);
  std::unordered_map<std::string_view, std::uint32_t> seen(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string_view key(reinterpret_cast<const char*>(&rows[i * row_size]),
                               row_size * sizeof(float));
    first[i] = seen.emplace(key, static_cast<std::uint32_t>(i)).first->second;
  }
  return first;
}

}  // namespace

std::vector<std::uint32_t> first_at_same_position(const TriangleMesh& mesh) {
  return first_equal(mesh.vertex_count(), [&](std::vector<float>& row, std::size_t vertex) {
    append(row, mesh.positions, vertex);
  });
}

std::vector<std::uint32_t> first_with_same_attributes(const TriangleMesh& mesh) {
  return first_equal(mesh.vertex_count(), [&](std::vector<float>& row, std::size_t vertex) {
    append(row, mesh.positions, vertex);
    append(row, mesh.normals, vertex);
    append(row, mesh.tangents, vertex);
    append(row, mesh.texcoords, vertex);
    append(row, mesh.colors, vertex);
  });
}

}  // namespace prt::mesh
