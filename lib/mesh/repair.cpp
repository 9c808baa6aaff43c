#include "mesh/repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "mesh/normals.h"
#include "mesh/topology.h"
#include "mesh/weld.h"

namespace prt::mesh {

namespace {

using Dvec3 = Imath::V3d;

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
// Keeps a stored normal's bits when its length is this close to 1 (float rounding of a unit vector,
// or of one stored in 16 bits).
constexpr float kUnitTolerance = 1e-4f;

void move_to_first(TriangleMesh& mesh, const std::vector<std::uint32_t>& first) {
  for (std::uint32_t& index : mesh.indices) index = first[index];
}

bool has_area(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& corners) {
  const Dvec3 a(mesh.positions[corners[0]]), b(mesh.positions[corners[1]]),
      c(mesh.positions[corners[2]]);
  const double longest = std::max({(b - a).length2(), (c - b).length2(), (a - c).length2()});
  return (b - a).cross(c - a).length() > 1e-12 * longest;
}

// Keeps the triangles for which `keep` says so; returns how many went.
template <class Keep>
std::size_t filter_triangles(TriangleMesh& mesh, const Keep& keep) {
  const std::size_t count = mesh.triangle_count();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto corners = mesh.triangle(i);
    if (!keep(corners)) continue;
    std::copy(corners.begin(), corners.end(),
              mesh.indices.begin() + static_cast<std::ptrdiff_t>(3 * kept));
    ++kept;
  }
  mesh.indices.resize(3 * kept);
  return count - kept;
}

// Corners by position, turned so that the least comes first: equal for the same side of a triangle.
std::array<std::uint32_t, 3> canonical(std::array<std::uint32_t, 3> corners,
                                       const std::vector<std::uint32_t>& first) {
  for (std::uint32_t& corner : corners) corner = first[corner];
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

void drop_bad_triangles(TriangleMesh& mesh, RepairReport& report) {
  const auto finite = [&](std::uint32_t vertex) { return is_finite(mesh.positions[vertex]); };
  report.nonfinite_triangle_count += filter_triangles(mesh, [&](const auto& corners) {
    return std::all_of(corners.begin(), corners.end(), finite);
  });
  report.degenerate_triangle_count +=
      filter_triangles(mesh, [&](const auto& corners) { return has_area(mesh, corners); });
  const std::vector<std::uint32_t> first = first_at_same_position(mesh);
  std::set<std::array<std::uint32_t, 3>> seen;
  report.duplicate_triangle_count += filter_triangles(
      mesh, [&](const auto& corners) { return seen.insert(canonical(corners, first)).second; });
}

// Drops what no triangle uses; returns where the kept vertices stood.
std::vector<std::uint32_t> drop_unreferenced(TriangleMesh& mesh) {
  std::vector<std::uint32_t> target(mesh.vertex_count(), kUnused), source;
  for (const std::uint32_t index : mesh.indices) target[index] = 0;
  for (std::uint32_t i = 0; i < target.size(); ++i) {
    if (target[i] == kUnused) continue;
    target[i] = static_cast<std::uint32_t>(source.size());
    source.push_back(i);
  }
  for (std::uint32_t& index : mesh.indices) index = target[index];
  gather_vertices(mesh, source);
  return source;
}

bool is_good_normal(const Vec3& normal) {
  const float length = normal.length();
  return std::isfinite(length) && length > 1e-6f;
}

// Computes all normals; returns where the vertices (some perhaps split) came from.
std::vector<std::uint32_t> replace_normals(TriangleMesh& mesh, const RepairOptions& options) {
  if (options.crease_angle_degrees) return compute_normals(mesh, *options.crease_angle_degrees);
  TriangleMesh creased = mesh;
  auto source = compute_normals(creased, kCreaseAngle);
  const std::size_t split_count = creased.vertex_count() - mesh.vertex_count();
  if (split_count * kVerticesPerCrease < mesh.vertex_count()) return compute_normals(mesh, 180.0f);
  mesh = std::move(creased);
  return source;
}

// Fills in missing normals; returns where the vertices (some perhaps split) came from.
std::vector<std::uint32_t> complete_normals(TriangleMesh& mesh, const RepairOptions& options,
                                            RepairReport& report) {
  if (mesh.normals.empty()) {
    const std::size_t before = mesh.vertex_count();
    auto source = replace_normals(mesh, options);
    report.computed_normal_count += mesh.vertex_count();
    report.split_vertex_count += mesh.vertex_count() - before;
    return source;
  }
  std::vector<std::uint32_t> same(mesh.vertex_count());
  for (std::uint32_t i = 0; i < same.size(); ++i) same[i] = i;
  if (!std::all_of(mesh.normals.begin(), mesh.normals.end(), is_good_normal)) {
    TriangleMesh smooth;
    smooth.positions = mesh.positions;
    smooth.indices = mesh.indices;
    compute_normals(smooth, 180.0f);
    for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
      if (is_good_normal(mesh.normals[i])) continue;
      mesh.normals[i] = smooth.normals[i];
      ++report.computed_normal_count;
    }
  }
  for (Vec3& normal : mesh.normals) {
    if (std::abs(normal.length() - 1.0f) > kUnitTolerance) normal.normalize();
  }
  return same;
}

// Texture coordinates become (0, 0) and colours white where they are not finite; colours are
// clamped, as glTF wants them. Bad tangents all go: they follow from the texture coordinates.
void mend_attributes(TriangleMesh& mesh, RepairReport& report) {
  std::vector<bool> mended(mesh.vertex_count());
  for (std::size_t i = 0; i < mesh.texcoords.size(); ++i) {
    if (is_finite(mesh.texcoords[i])) continue;
    mesh.texcoords[i] = Vec2(0.0f);
    mended[i] = true;
  }
  for (std::size_t i = 0; i < mesh.colors.size(); ++i) {
    Vec4 color = is_finite(mesh.colors[i]) ? mesh.colors[i] : Vec4(1.0f);
    for (int c = 0; c < 4; ++c) color[c] = std::clamp(color[c], 0.0f, 1.0f);
    if (color == mesh.colors[i]) continue;
    mesh.colors[i] = color;
    mended[i] = true;
  }
  report.mended_attribute_count +=
      static_cast<std::size_t>(std::count(mended.begin(), mended.end(), true));
  if (!std::all_of(mesh.tangents.begin(), mesh.tangents.end(), is_finite<Vec4>)) {
    mesh.tangents.clear();
  }
}

template <class T>
void gather(std::vector<T>& values, const std::vector<std::uint32_t>& source) {
  if (values.empty()) return;
  std::vector<T> gathered;
  gathered.reserve(source.size());
  for (const std::uint32_t i : source) gathered.push_back(values[i]);
  values = std::move(gathered);
}

}  // namespace

void RepairReport::add(const RepairReport& other) {
  welded_vertex_count += other.welded_vertex_count;
  nonfinite_vertex_count += other.nonfinite_vertex_count;
  unreferenced_vertex_count += other.unreferenced_vertex_count;
  degenerate_triangle_count += other.degenerate_triangle_count;
  duplicate_triangle_count += other.duplicate_triangle_count;
  nonfinite_triangle_count += other.nonfinite_triangle_count;
  computed_normal_count += other.computed_normal_count;
  split_vertex_count += other.split_vertex_count;
  mended_attribute_count += other.mended_attribute_count;
  nonmanifold_triangle_count += other.nonmanifold_triangle_count;
  nonmanifold_vertex_count += other.nonmanifold_vertex_count;
  boundary_edge_count += other.boundary_edge_count;
}

void gather_vertices(TriangleMesh& mesh, const std::vector<std::uint32_t>& source) {
  gather(mesh.positions, source);
  gather(mesh.normals, source);
  gather(mesh.tangents, source);
  gather(mesh.texcoords, source);
  gather(mesh.colors, source);
}

std::vector<std::uint32_t> repair(TriangleMesh& mesh, const RepairOptions& options,
                                  RepairReport& report) {
  if (options.recompute_normals) {
    mesh.normals.clear();
    mesh.tangents.clear();
  }
  std::size_t nonfinite = 0, welded = 0;
  for (const Vec3& position : mesh.positions) nonfinite += !is_finite(position);
  const std::size_t before = mesh.vertex_count();
  if (options.weld) {
    const std::vector<std::uint32_t> first = first_with_same_attributes(mesh);
    for (std::uint32_t i = 0; i < first.size(); ++i) {
      welded += first[i] != i && is_finite(mesh.positions[i]);
    }
    move_to_first(mesh, first);
  }
  drop_bad_triangles(mesh, report);
  std::vector<std::uint32_t> source = drop_unreferenced(mesh);
  report.nonfinite_vertex_count += nonfinite;
  report.welded_vertex_count += welded;
  report.unreferenced_vertex_count += before - mesh.vertex_count() - nonfinite - welded;
  mend_attributes(mesh, report);

  const std::vector<std::uint32_t> split = complete_normals(mesh, options, report);
  std::vector<std::uint32_t> composed;
  composed.reserve(split.size());
  for (const std::uint32_t vertex : split) composed.push_back(source[vertex]);

  const Topology topology = examine_topology(mesh);
  report.nonmanifold_triangle_count += topology.nonmanifold_triangle_count;
  report.nonmanifold_vertex_count += topology.nonmanifold_vertex_count;
  report.boundary_edge_count += topology.boundary_edge_count;
  return composed;
}

}  // namespace prt::mesh
