// What the runtime draws: the triangles of a file's scene with their transfer, compressed,
// uncompressed or both.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "camera/camera.h"
#include "gltf/precomputed_transfer.h"
#include "mesh/scene.h"
#include "signal/transfer_signal.h"

namespace prt::runtime {

/// Vertices of all primitives, numbered through as in mesh::Scene, and their triangles in the order
/// of runtime/triangle_order.h.
struct Model {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> indices;
  /// Frames of the vertices (mesh/frame.h) of glossy transfer, else empty: x in xyz, w is -1 where
  /// the frame is left-handed.
  std::vector<Vec3> normals;
  std::vector<Vec4> tangents;
  camera::Sphere bounds;
  std::optional<gltf::PrecomputedTransfer> transfer;  ///< compressed
  std::optional<signal::TransferSignal> signal;       ///< uncompressed

  int band_count() const;  ///< of the transfer; 0 without any
  int row_count() const;   ///< exit values a colour; 1 when diffuse
};

/// Throws Error (bad_input) when a transfer has another number of vertices or exit rows that are no
/// set of functions (sh::hemisphere_functions), or when two transfers differ in bands, rows or
/// channels.
Model make_model(const mesh::Scene& scene, std::optional<gltf::PrecomputedTransfer> transfer,
                 std::optional<signal::TransferSignal> signal);

/// Reads a .glb and, unless empty, the transfer file of its mesh. Throws Error (bad_input) when
/// there is no transfer in either, or the transfer file belongs to another mesh. Warns when the
/// model's own transfer was baked for other geometry or colours.
Model load_model(const std::filesystem::path& glb, const std::filesystem::path& transfer = {});

/// Root mean square error of each vertex' compressed transfer, relative to the root mean square
/// of the signal; of glossy transfer as exit radiance (sh/radiance_metric.h). Empty unless the
/// model has both transfers.
std::vector<float> relative_errors(const Model& model);
/// Their root mean square: the relative error of the whole compression. 0 without both transfers.
float relative_error(const Model& model);

}  // namespace prt::runtime
