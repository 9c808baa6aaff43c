#include "mesh/normals.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>

#include "mesh/repair.h"
#include "mesh/weld.h"

namespace prt::mesh {

namespace {

using Dvec3 = Imath::V3d;

struct Face {
  Dvec3 normal;
  std::array<double, 3> angles;  // at its corners
};

double angle_between(const Dvec3& a, const Dvec3& b) {
  return std::atan2(a.cross(b).length(), a.dot(b));
}

std::vector<Face> make_faces(const TriangleMesh& mesh) {
  std::vector<Face> faces(mesh.triangle_count());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const auto corners = mesh.triangle(i);
    std::array<Dvec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = Dvec3(mesh.positions[corners[k]]);
    faces[i].normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      faces[i].angles[k] = angle_between(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
    }
  }
  return faces;
}

std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

// The smaller root wins, so the result does not depend on the order of joining.
void join(std::vector<std::uint32_t>& parent, std::uint32_t a, std::uint32_t b) {
  a = find_root(parent, a);
  b = find_root(parent, b);
  parent[std::max(a, b)] = std::min(a, b);
}

struct HalfEdge {
  std::uint32_t low, high;                // positions
  std::uint32_t corner_low, corner_high;  // corners of its triangle at them
};

// Corners that share a normal: those at one position, joined across edges that are not hard.
std::vector<std::uint32_t> group_corners(const TriangleMesh& mesh, const std::vector<Face>& faces,
                                         const std::vector<std::uint32_t>& first,
                                         float crease_angle_degrees) {
  std::vector<HalfEdge> edges;
  edges.reserve(mesh.indices.size());
  for (std::uint32_t corner = 0; corner < mesh.indices.size(); ++corner) {
    const std::uint32_t next = corner % 3 == 2 ? corner - 2 : corner + 1;
    HalfEdge edge{first[mesh.indices[corner]], first[mesh.indices[next]], corner, next};
    if (edge.low > edge.high) {
      std::swap(edge.low, edge.high);
      std::swap(edge.corner_low, edge.corner_high);
    }
    edges.push_back(edge);
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.low, a.high, a.corner_low) < std::tie(b.low, b.high, b.corner_low);
  });
  std::vector<std::uint32_t> parent(mesh.indices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const double crease = crease_angle_degrees * std::numbers::pi / 180.0;
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const HalfEdge &a = edges[i - 1], &b = edges[i];
    if (a.low != b.low || a.high != b.high) continue;
    if (angle_between(faces[a.corner_low / 3].normal, faces[b.corner_low / 3].normal) > crease) {
      continue;
    }
    join(parent, a.corner_low, b.corner_low);
    join(parent, a.corner_high, b.corner_high);
  }
  for (std::uint32_t i = 0; i < parent.size(); ++i) parent[i] = find_root(parent, i);
  return parent;
}

// Gives every (vertex, group) pair a vertex of its own: the first pair keeps the vertex, others are
// appended. Returns where vertices came from.
std::vector<std::uint32_t> split_vertices(TriangleMesh& mesh,
                                          const std::vector<std::uint32_t>& group_of_corner) {
  constexpr std::uint32_t kNone = 0xffffffffu;
  std::vector<std::uint32_t> source(mesh.vertex_count());
  std::iota(source.begin(), source.end(), 0u);
  std::vector<std::uint32_t> first_group(mesh.vertex_count(), kNone);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> copies;
  for (std::size_t corner = 0; corner < mesh.indices.size(); ++corner) {
    std::uint32_t& index = mesh.indices[corner];
    const std::uint32_t group = group_of_corner[corner];
    if (first_group[index] == kNone) first_group[index] = group;
    if (first_group[index] == group) continue;
    const auto [copy, added] =
        copies.try_emplace({index, group}, static_cast<std::uint32_t>(source.size()));
    if (added) source.push_back(index);
    index = copy->second;
  }
  gather_vertices(mesh, source);
  return source;
}

Vec3 any_perpendicular(const Vec3& n) {
  const Vec3 axis = std::abs(n.x) < 0.5f ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  return (axis - n * n.dot(axis)).normalized();
}

}  // namespace

std::vector<std::uint32_t> compute_normals(TriangleMesh& mesh, float crease_angle_degrees) {
  const std::vector<Face> faces = make_faces(mesh);
  const std::vector<std::uint32_t> first = first_at_same_position(mesh);
  std::vector<std::uint32_t> group(mesh.indices.size());
  if (crease_angle_degrees >= 180.0f) {
    for (std::size_t i = 0; i < group.size(); ++i) group[i] = first[mesh.indices[i]];
  } else {
    group = group_corners(mesh, faces, first, crease_angle_degrees);
  }
  mesh.normals.clear();
  std::vector<std::uint32_t> source = split_vertices(mesh, group);

  // Groups are numbered by a corner or a position, whichever range is longer holds both.
  std::vector<Dvec3> sums(std::max(mesh.indices.size(), first.size()), Dvec3(0.0));
  for (std::size_t i = 0; i < group.size(); ++i) {
    sums[group[i]] += faces[i / 3].normal * faces[i / 3].angles[i % 3];
  }
  mesh.normals.assign(mesh.vertex_count(), Vec3(0, 1, 0));
  for (std::size_t i = 0; i < group.size(); ++i) {
    // Faces back to back cancel out: the vertex then takes the side of one of them.
    const Dvec3& sum = sums[group[i]];
    const Dvec3 normal = sum.length() > 1e-9 ? sum.normalized() : faces[i / 3].normal;
    mesh.normals[mesh.indices[i]] = Vec3(normal);
  }
  return source;
}

void compute_tangents(TriangleMesh& mesh) {
  std::vector<Dvec3> tangents(mesh.vertex_count(), Dvec3(0.0));
  std::vector<double> sides(mesh.vertex_count(), 0.0);
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const auto [a, b, c] = mesh.triangle(i);
    const Dvec3 e1(mesh.positions[b] - mesh.positions[a]),
        e2(mesh.positions[c] - mesh.positions[a]);
    const Imath::V2d t1(mesh.texcoords[b] - mesh.texcoords[a]),
        t2(mesh.texcoords[c] - mesh.texcoords[a]);
    const double determinant = t1.x * t2.y - t1.y * t2.x;
    if (determinant == 0.0 || !std::isfinite(determinant)) continue;
    // Length: the triangle's area, the weight of its direction.
    const Dvec3 direction = (e1 * t2.y - e2 * t1.y) / determinant;
    const double area = e1.cross(e2).length();
    if (!(direction.length() > 0.0)) continue;
    for (const std::uint32_t vertex : {a, b, c}) {
      tangents[vertex] += direction.normalized() * area;
      // Texture coordinates grow downwards in glTF: a positive determinant is a mirrored one there.
      sides[vertex] += determinant > 0.0 ? -area : area;
    }
  }
  mesh.tangents.resize(mesh.vertex_count());
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    const Vec3& n = mesh.normals[i];
    const Dvec3 flat = tangents[i] - Dvec3(n) * Dvec3(n).dot(tangents[i]);
    const bool good = flat.length() > 1e-9 * tangents[i].length() && std::isfinite(flat.length()) &&
                      flat.length() > 0.0;
    const Vec3 t = good ? Vec3(flat.normalized()) : any_perpendicular(n);
    mesh.tangents[i] = Vec4(t.x, t.y, t.z, sides[i] < 0.0 ? -1.0f : 1.0f);
  }
}

}  // namespace prt::mesh
