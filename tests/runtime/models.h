// Models made in memory for the tests of the runtime: no file, no baking.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "mesh/scene.h"
#include "runtime/model.h"
#include "sh/basis.h"
#include "sh/light.h"

namespace prt::runtime {

/// A closed torus around Y: it hides parts of itself, which a convex body does not.
inline mesh::TriangleMesh torus(std::uint32_t rings, std::uint32_t sides) {
  mesh::TriangleMesh mesh;
  constexpr float kTwoPi = 2 * std::numbers::pi_v<float>;
  for (std::uint32_t i = 0; i < rings; ++i)
    for (std::uint32_t j = 0; j < sides; ++j) {
      const float a = kTwoPi * static_cast<float>(i) / static_cast<float>(rings);
      const float b = kTwoPi * static_cast<float>(j) / static_cast<float>(sides);
      const Vec3 outward(std::cos(a), 0, std::sin(a));
      const Vec3 normal = outward * std::cos(b) + Vec3(0, std::sin(b), 0);
      mesh.positions.push_back(outward + normal * 0.4f);
      mesh.normals.push_back(normal);
      const std::uint32_t i1 = (i + 1) % rings, j1 = (j + 1) % sides;
      const std::uint32_t p00 = i * sides + j, p10 = i1 * sides + j, p01 = i * sides + j1,
                          p11 = i1 * sides + j1;
      mesh.indices.insert(mesh.indices.end(), {p00, p01, p11, p00, p11, p10});
    }
  return mesh;
}

inline mesh::TriangleMesh sphere(std::uint32_t rings, std::uint32_t sides) {
  mesh::TriangleMesh mesh;
  for (std::uint32_t i = 0; i <= rings; ++i)
    for (std::uint32_t j = 0; j <= sides; ++j) {
      const float theta =
          std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(rings);
      const float phi =
          2 * std::numbers::pi_v<float> * static_cast<float>(j) / static_cast<float>(sides);
      const Vec3 p(std::sin(theta) * std::sin(phi), std::cos(theta),
                   std::sin(theta) * std::cos(phi));
      mesh.positions.push_back(p);
      mesh.normals.push_back(p);
      if (i == rings || j == sides) continue;
      const std::uint32_t a = i * (sides + 1) + j, b = a + sides + 1;
      if (i > 0) mesh.indices.insert(mesh.indices.end(), {a, b, a + 1});
      if (i + 1 < rings) mesh.indices.insert(mesh.indices.end(), {a + 1, b, b + 1});
    }
  return mesh;
}

inline mesh::Scene scene_of(std::vector<mesh::TriangleMesh> meshes) {
  mesh::Scene scene;
  for (mesh::TriangleMesh& mesh : meshes) {
    scene.primitives.emplace_back();
    scene.primitives.back().mesh = std::move(mesh);
  }
  return scene;
}

/// Unshadowed diffuse transfer, which is known in closed form: the clamped cosine about the normal
/// scales band l by 1, 2/3, 1/4, 0, -1/24 [Ramamoorthi, Hanrahan 2001], divided by pi.
inline signal::TransferSignal unshadowed(const mesh::Scene& scene, int band_count,
                                         const std::vector<Vec3>& albedo_by_channel) {
  constexpr float kBands[] = {1.0f, 2.0f / 3.0f, 0.25f, 0.0f, -1.0f / 24.0f};
  signal::TransferSignal signal;
  signal.band_count = band_count;
  signal.channel_count = static_cast<int>(albedo_by_channel.size());
  std::vector<float> basis(static_cast<std::size_t>(band_count * band_count));
  for (const mesh::Primitive& primitive : scene.primitives) {
    signal.blocks.push_back({primitive.name, primitive.mesh.vertex_count()});
    for (const Vec3& n : primitive.mesh.normals) {
      sh::evaluate(band_count, n, basis);
      for (const Vec3& a : albedo_by_channel) {
        // The albedo varies over the model, so that no few clusters hold the signal exactly.
        const float albedo = 0.5f + 0.4f * std::sin(3 * a.dot(n));
        for (int l = 0, k = 0; l < band_count; ++l)
          for (int m = -l; m <= l; ++m, ++k)
            signal.values.push_back(albedo * (l < 5 ? kBands[l] : 0.0f) *
                                    basis[static_cast<std::size_t>(k)]);
      }
    }
  }
  return signal;
}

/// A compression of `signal` that keeps everything: one basis of all coordinate axes a cluster,
/// clusters scattered over the vertices.
inline gltf::PrecomputedTransfer full_rank(const signal::TransferSignal& signal,
                                           int cluster_count) {
  gltf::PrecomputedTransfer transfer;
  transfer.band_count = signal.band_count;
  transfer.channel_count = signal.channel_count;
  transfer.row_count = signal.row_count;
  cpca::Encoding& e = transfer.encoding;
  const auto n = static_cast<std::size_t>(signal.dimension());
  e.point_count = signal.vertex_count();
  e.dimension = e.component_count = signal.dimension();
  e.cluster_count = cluster_count;
  Pcg32 random(7);
  for (int k = 0; k < cluster_count; ++k)
    for (std::size_t i = 0; i < n; ++i) {
      e.means.push_back(random.uniform() - 0.5f);
      for (std::size_t j = 0; j < n; ++j) e.bases.push_back(i == j ? 1.0f : 0.0f);
    }
  for (std::size_t p = 0; p < e.point_count; ++p) {
    const std::uint32_t cluster = random.below(static_cast<std::uint32_t>(cluster_count));
    e.cluster_of_point.push_back(cluster);
    for (std::size_t i = 0; i < n; ++i)
      e.weights.push_back(signal.values[p * n + i] - e.means[cluster * n + i]);
  }
  return transfer;
}

/// Random means, bases and weights: any numbers must draw alike both ways.
inline gltf::PrecomputedTransfer random_transfer(std::size_t vertex_count, int band_count,
                                                 int channel_count, int cluster_count,
                                                 int component_count, int row_count = 1) {
  gltf::PrecomputedTransfer transfer;
  transfer.band_count = band_count;
  transfer.channel_count = channel_count;
  transfer.row_count = row_count;
  cpca::Encoding& e = transfer.encoding;
  e.point_count = vertex_count;
  e.dimension = channel_count * row_count * band_count * band_count;
  e.cluster_count = cluster_count;
  e.component_count = component_count;
  Pcg32 random(11);
  const auto fill = [&](std::vector<float>& values, int count) {
    for (int i = 0; i < count; ++i) values.push_back(random.uniform() - 0.5f);
  };
  fill(e.means, cluster_count * e.dimension);
  fill(e.bases, cluster_count * component_count * e.dimension);
  fill(e.weights, static_cast<int>(vertex_count) * component_count);
  for (std::size_t p = 0; p < vertex_count; ++p)
    e.cluster_of_point.push_back(random.below(static_cast<std::uint32_t>(cluster_count)));
  return transfer;
}

/// The same as adaptive CPCA has it: clusters of 0 to `component_count` vectors.
inline gltf::PrecomputedTransfer random_adaptive_transfer(std::size_t vertex_count, int band_count,
                                                          int channel_count, int cluster_count,
                                                          int component_count, int row_count = 1) {
  gltf::PrecomputedTransfer transfer = random_transfer(vertex_count, band_count, channel_count,
                                                       cluster_count, component_count, row_count);
  cpca::Encoding& e = transfer.encoding;
  const auto components = static_cast<std::size_t>(component_count);
  const auto n = static_cast<std::size_t>(e.dimension);
  Pcg32 random(5);
  for (std::size_t k = 0; k < static_cast<std::size_t>(cluster_count); ++k) {
    const std::uint32_t own = random.below(static_cast<std::uint32_t>(component_count) + 1);
    e.component_counts.push_back(own);
    for (std::size_t i = (k * components + own) * n; i < (k + 1) * components * n; ++i)
      e.bases[i] = 0.0f;
  }
  for (std::size_t p = 0; p < vertex_count; ++p)
    for (std::size_t i = e.component_counts[e.cluster_of_point[p]]; i < components; ++i)
      e.weights[p * components + i] = 0.0f;
  return transfer;
}

/// Superclusters of `size` clusters each, the last smaller.
inline gltf::PrecomputedTransfer with_superclusters(gltf::PrecomputedTransfer transfer, int size) {
  for (int k = 0; k < transfer.encoding.cluster_count; k += size)
    transfer.first_clusters.push_back(static_cast<std::uint32_t>(k));
  return transfer;
}

/// Coloured, bright from one side, with something in every band.
inline sh::Light test_light(int band_count) {
  sh::Light light(band_count);
  Pcg32 random(3);
  for (std::vector<float>& color : light.coefficients)
    for (std::size_t k = 0; k < color.size(); ++k)
      color[k] = (random.uniform() - 0.3f) / (1.0f + 0.2f * static_cast<float>(k));
  for (std::vector<float>& color : light.coefficients) color[0] = 2.5f;
  return light;
}

}  // namespace prt::runtime
