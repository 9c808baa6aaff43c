#include "mesh/tessellate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "core/error.h"

namespace prt::mesh {

namespace {

constexpr std::uint32_t kWhole = 0xffffffffu;

template <class T>
void append_midpoint(std::vector<T>& values, std::uint32_t a, std::uint32_t b) {
  // a + b before halving: the same bits whichever comes first.
  if (!values.empty()) values.push_back((values[a] + values[b]) * 0.5f);
}

class Refiner {
 public:
  Refiner(TriangleMesh& mesh, float max_edge, const Matrix4& world_from_local)
      : mesh_(mesh), max_edge_(max_edge), world_from_local_(world_from_local) {}

  /// One pass over all triangles; false when no edge was too long.
  bool refine() {
    midpoints_.clear();
    std::vector<std::uint32_t> refined;
    refined.reserve(mesh_.indices.size());
    for (std::size_t i = 0; i < mesh_.triangle_count(); ++i) split(mesh_.triangle(i), refined);
    mesh_.indices = std::move(refined);
    return !midpoints_.empty();
  }

 private:
  bool is_long(std::uint32_t a, std::uint32_t b) const {
    const Vec3 edge = transform_point(world_from_local_, mesh_.positions[a]) -
                      transform_point(world_from_local_, mesh_.positions[b]);
    // A midpoint that rounds to an end cannot make the edge shorter.
    const Vec3 middle = (mesh_.positions[a] + mesh_.positions[b]) * 0.5f;
    return edge.length() > max_edge_ && middle != mesh_.positions[a] &&
           middle != mesh_.positions[b];
  }

  // The vertex in the middle of an edge that is too long, else kWhole.
  std::uint32_t middle_of(std::uint32_t a, std::uint32_t b) {
    if (!is_long(a, b)) return kWhole;
    const std::uint64_t key = std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
    const auto [middle, added] =
        midpoints_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertex_count()));
    if (added) append_vertex(std::min(a, b), std::max(a, b));
    return middle->second;
  }

  void append_vertex(std::uint32_t a, std::uint32_t b) {
    append_midpoint(mesh_.positions, a, b);
    append_midpoint(mesh_.texcoords, a, b);
    append_midpoint(mesh_.colors, a, b);
    if (!mesh_.normals.empty()) {
      const Vec3 sum = mesh_.normals[a] + mesh_.normals[b];
      mesh_.normals.push_back(sum.length() > 1e-6f ? sum.normalized() : mesh_.normals[a]);
    }
    if (!mesh_.tangents.empty()) {
      const Vec4 sum = mesh_.tangents[a] + mesh_.tangents[b];
      const Vec3 t = Vec3(sum.x, sum.y, sum.z);
      const Vec3 unit = t.length() > 1e-6f
                            ? t.normalized()
                            : Vec3(mesh_.tangents[a].x, mesh_.tangents[a].y, mesh_.tangents[a].z);
      mesh_.tangents.emplace_back(unit.x, unit.y, unit.z, mesh_.tangents[a].w);
    }
  }

  void split(std::array<std::uint32_t, 3> v, std::vector<std::uint32_t>& out) {
    std::array<std::uint32_t, 3> m;
    int long_count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      m[k] = middle_of(v[k], v[(k + 1) % 3]);
      long_count += m[k] != kWhole;
    }
    // Turned so that an only long edge comes first, or an only short edge last.
    while ((long_count == 1 && m[0] == kWhole) || (long_count == 2 && m[2] != kWhole)) {
      v = {v[1], v[2], v[0]};
      m = {m[1], m[2], m[0]};
    }
    const auto emit = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      out.insert(out.end(), {a, b, c});
    };
    switch (long_count) {
      case 0:
        return emit(v[0], v[1], v[2]);
      case 1:
        emit(v[0], m[0], v[2]);
        return emit(m[0], v[1], v[2]);
      case 2:
        emit(m[0], v[1], m[1]);
        return split_quad(v[0], m[0], m[1], v[2], out);
      default:
        emit(v[0], m[0], m[2]);
        emit(m[0], v[1], m[1]);
        emit(m[2], m[1], v[2]);
        return emit(m[0], m[1], m[2]);
    }
  }

  // Along the shorter diagonal, which lies inside and disturbs no neighbour.
  void split_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d,
                  std::vector<std::uint32_t>& out) const {
    const float ac = (mesh_.positions[a] - mesh_.positions[c]).length2();
    const float bd = (mesh_.positions[b] - mesh_.positions[d]).length2();
    if (ac <= bd) {
      out.insert(out.end(), {a, b, c, a, c, d});
    } else {
      out.insert(out.end(), {a, b, d, b, c, d});
    }
  }

  TriangleMesh& mesh_;
  float max_edge_;
  const Matrix4& world_from_local_;
  std::unordered_map<std::uint64_t, std::uint32_t> midpoints_;
};

// Pieces of edges up to max_edge cover an area of at most √3/4 max_edge² each, and an edge of
// length L ends up as at least L / max_edge edges of different pieces.
double least_triangle_count(const TriangleMesh& mesh, double max_edge,
                            const Matrix4& world_from_local) {
  double sum = 0.0;
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    std::array<Imath::V3d, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = Imath::V3d(transform_point(world_from_local, mesh.positions[mesh.triangle(i)[k]]));
    }
    const double longest =
        std::max({(p[1] - p[0]).length(), (p[2] - p[1]).length(), (p[0] - p[2]).length()});
    const double area = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).length();
    sum += std::max({1.0, area / (std::sqrt(3.0) / 4.0 * max_edge * max_edge), longest / max_edge});
  }
  return sum;
}

void check_count(double count, std::size_t max_triangles) {
  if (count <= static_cast<double>(max_triangles)) return;
  throw_failed("refining makes too many triangles",
               {.found = fmt::format("at least {:.3g}", count),
                .expected = fmt::format("at most {}", max_triangles),
                .advice = "Use a longer --max-edge, or allow more with --max-triangles."});
}

}  // namespace

void tessellate(TriangleMesh& mesh, float max_edge, std::size_t max_triangles,
                const Matrix4& world_from_local) {
  check_count(least_triangle_count(mesh, max_edge, world_from_local), max_triangles);
  Refiner refiner(mesh, max_edge, world_from_local);
  while (refiner.refine()) {
    check_count(static_cast<double>(mesh.triangle_count()), max_triangles);
  }
}

}  // namespace prt::mesh
