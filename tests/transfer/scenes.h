// Small scenes of the transfer tests, and what they share.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

#include "mesh/scene.h"
#include "sh/basis.h"
#include "transfer/diffuse.h"

namespace prt::transfer {

using mesh::TriangleMesh;

/// Grid of n × n squares over origin + [0, 1] a + [0, 1] b; its front sees along a × b.
inline TriangleMesh grid(const Vec3& origin, const Vec3& a, const Vec3& b, std::uint32_t n) {
  TriangleMesh mesh;
  const Vec3 normal = a.cross(b).normalized();
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i) {
      const float u = static_cast<float>(i) / static_cast<float>(n);
      const float v = static_cast<float>(j) / static_cast<float>(n);
      mesh.positions.push_back(origin + a * u + b * v);
      mesh.normals.push_back(normal);
    }
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t k = j * (n + 1) + i;
      for (std::uint32_t corner : {k, k + 1, k + n + 2, k, k + n + 2, k + n + 1}) {
        mesh.indices.push_back(corner);
      }
    }
  }
  return mesh;
}

inline void append(TriangleMesh& mesh, const TriangleMesh& part) {
  const auto offset = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
  mesh.normals.insert(mesh.normals.end(), part.normals.begin(), part.normals.end());
  for (std::uint32_t i : part.indices) mesh.indices.push_back(i + offset);
}

/// Closed box, front faces outside, n × n squares a face.
inline TriangleMesh box(const Vec3& low, const Vec3& high, std::uint32_t n) {
  const Vec3 s = high - low, x(s.x, 0, 0), y(0, s.y, 0), z(0, 0, s.z);
  TriangleMesh mesh;
  append(mesh, grid(low, y, x, n));
  append(mesh, grid(low, z, y, n));
  append(mesh, grid(low, x, z, n));
  append(mesh, grid(high, -x, -y, n));
  append(mesh, grid(high, -y, -z, n));
  append(mesh, grid(high, -z, -x, n));
  return mesh;
}

/// Front faces and normals on the other side.
inline TriangleMesh turned_inside_out(TriangleMesh mesh) {
  for (Vec3& n : mesh.normals) n = -n;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  }
  return mesh;
}

/// Unit sphere, front faces outside: an octahedron, each triangle split in four `level` times. With
/// `lower_half` only what lies below y = 0.
inline TriangleMesh sphere(int level, bool lower_half = false) {
  TriangleMesh mesh;
  mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  if (lower_half) {
    mesh.indices = {1, 3, 4, 3, 0, 4, 3, 1, 5, 0, 3, 5};
  } else {
    mesh.indices = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  }
  for (; level > 0; --level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [place, added] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.positions.size()));
      if (added) mesh.positions.push_back((mesh.positions[a] + mesh.positions[b]).normalized());
      return place->second;
    };
    std::vector<std::uint32_t> split;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (std::uint32_t k : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca}) split.push_back(k);
    }
    mesh.indices = std::move(split);
  }
  mesh.normals = mesh.positions;
  return mesh;
}

inline void add(mesh::Scene& scene, const TriangleMesh& mesh, const Vec3& albedo = Vec3(1.0f)) {
  mesh::Material material;
  material.base_color = Vec4(albedo.x, albedo.y, albedo.z, 1.0f);
  scene.materials.push_back(material);
  mesh::Primitive primitive;
  primitive.name = "part " + std::to_string(scene.primitives.size());
  primitive.mesh = mesh;
  primitive.material = static_cast<int>(scene.materials.size()) - 1;
  scene.primitives.push_back(primitive);
}

inline mesh::Scene scene_of(const TriangleMesh& mesh) {
  mesh::Scene scene;
  add(scene, mesh);
  return scene;
}

inline signal::TransferSignal compute(const mesh::Scene& scene, const DiffuseOptions& options) {
  DiffuseStats stats;
  return compute_diffuse(scene, options, stats);
}

inline const float* row(const signal::TransferSignal& signal, std::size_t vertex) {
  return &signal.values[vertex * static_cast<std::size_t>(signal.dimension())];
}

/// Exit radiance under constant unit radiance: its only coefficient is 2 sqrt(pi).
inline double under_constant_light(const signal::TransferSignal& signal, std::size_t vertex,
                                   int channel = 0) {
  const int first = channel * sh::coefficient_count(signal.band_count);
  return 2.0 * std::sqrt(std::numbers::pi) * row(signal, vertex)[first];
}

inline double largest_difference(const signal::TransferSignal& a, const signal::TransferSignal& b) {
  double largest = a.values.size() == b.values.size() && !a.values.empty() ? 0.0 : INFINITY;
  for (std::size_t i = 0; i < a.values.size() && i < b.values.size(); ++i) {
    largest = std::max(largest, std::abs(double{a.values[i]} - double{b.values[i]}));
  }
  return largest;
}

/// A room without its front, floor, back, roof and walls seen from inside; the walls are coloured.
inline mesh::Scene coloured_box(std::uint32_t n) {
  mesh::Scene scene;
  add(scene, grid({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}, n), Vec3(0.75f));
  add(scene, grid({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, n), Vec3(0.75f));
  add(scene, grid({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, n), Vec3(0.75f));
  add(scene, grid({-1, -1, 1}, {0, 0, -2}, {0, 2, 0}, n), Vec3(0.8f, 0.1f, 0.1f));
  add(scene, grid({1, -1, -1}, {0, 0, 2}, {0, 2, 0}, n), Vec3(0.1f, 0.7f, 0.1f));
  return scene;
}

}  // namespace prt::transfer
