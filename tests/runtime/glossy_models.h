// Glossy models made in memory.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/frame.h"
#include "runtime/models.h"
#include "sh/rotation.h"

namespace prt::runtime {

/// Tangents of any direction and handedness: no two neighbours have the same frame.
inline mesh::TriangleMesh with_random_tangents(mesh::TriangleMesh mesh) {
  Pcg32 random(23);
  for (const Vec3& n : mesh.normals) {
    Vec3 tangent;
    do {
      tangent = Vec3(random.uniform(), random.uniform(), random.uniform()) * 2.0f - Vec3(1.0f);
      tangent -= n * n.dot(tangent);
    } while (tangent.length() < 0.1f);
    tangent.normalize();
    mesh.tangents.emplace_back(tangent.x, tangent.y, tangent.z,
                               random.uniform() < 0.5f ? -1.0f : 1.0f);
  }
  return mesh;
}

/// Transfer that sends in every direction the radiance that arrives from there, whatever the
/// vertices' frames: M_p turns the light into the frame. The model looks like the light itself,
/// reversed.
inline signal::TransferSignal passing_on(const mesh::Scene& scene, int band_count) {
  signal::TransferSignal signal;
  signal.band_count = band_count;
  signal.row_count = sh::coefficient_count(band_count);
  for (const mesh::Primitive& primitive : scene.primitives) {
    signal.blocks.push_back({primitive.name, primitive.mesh.vertex_count()});
    for (std::size_t v = 0; v < primitive.mesh.vertex_count(); ++v) {
      const mesh::Frame frame = mesh::frame_at_vertex(primitive.mesh, v);
      const Vec3 y = frame.z.cross(frame.x);
      const float side = y.dot(frame.y);
      const Matrix4 local_from_world(frame.x.x, y.x, frame.z.x, 0, frame.x.y, y.y, frame.z.y, 0,
                                     frame.x.z, y.z, frame.z.z, 0, 0, 0, 0, 1);
      const sh::Rotation rotation(band_count, local_from_world);
      for (int l = 0; l < band_count; ++l)
        for (int m = -l; m <= l; ++m)
          for (int k = 0; k < band_count; ++k)
            for (int n = -k; n <= k; ++n)
              signal.values.push_back(
                  k != l ? 0.0f : static_cast<float>(rotation.at(l, m, n)) * (m < 0 ? side : 1.0f));
    }
  }
  return signal;
}

/// A compression that is exact: two vertices a cluster, their mean and half their difference.
inline gltf::PrecomputedTransfer in_pairs(const signal::TransferSignal& signal) {
  gltf::PrecomputedTransfer transfer;
  transfer.band_count = signal.band_count;
  transfer.row_count = signal.row_count;
  transfer.channel_count = signal.channel_count;
  cpca::Encoding& e = transfer.encoding;
  const auto n = static_cast<std::size_t>(signal.dimension());
  e.point_count = signal.vertex_count();
  e.dimension = signal.dimension();
  e.component_count = 1;
  for (std::size_t p = 0; p < e.point_count; ++p) {
    e.cluster_of_point.push_back(static_cast<std::uint32_t>(p / 2));
    e.weights.push_back(p % 2 == 0 ? 1.0f : -1.0f);
    if (p % 2 != 0) continue;
    ++e.cluster_count;
    const float* const a = &signal.values[p * n];
    const float* const b = p + 1 < e.point_count ? a + n : a;
    for (std::size_t i = 0; i < n; ++i) {
      e.means.push_back((a[i] + b[i]) / 2);
      e.bases.push_back((a[i] - b[i]) / 2);
    }
  }
  return transfer;
}

/// What a compression stands for.
inline signal::TransferSignal decompressed(const gltf::PrecomputedTransfer& transfer) {
  signal::TransferSignal signal;
  signal.band_count = transfer.band_count;
  signal.row_count = transfer.row_count;
  signal.channel_count = transfer.channel_count;
  signal.blocks = {{"all", transfer.encoding.point_count}};
  const auto dimension = static_cast<std::size_t>(signal.dimension());
  signal.values.resize(transfer.encoding.point_count * dimension);
  for (std::size_t p = 0; p < transfer.encoding.point_count; ++p)
    cpca::reconstruct(transfer.encoding, p,
                      std::span(signal.values).subspan(p * dimension, dimension));
  return signal;
}

}  // namespace prt::runtime
