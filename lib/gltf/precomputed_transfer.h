// The content of the glTF extension PRTKIT_precomputed_transfer (docs/extensions).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cpca/encoding.h"
#include "cpca/weight_format.h"

namespace prt::gltf {

constexpr const char* kTransferExtension = "PRTKIT_precomputed_transfer";

/// What the extension has room for.
constexpr int kMaxBandCount = 16, kMaxClusterCount = 65536, kMaxComponentCount = 256;

/// Compressed transfer of all vertices of a file's scene, numbered through as in mesh::Scene. A
/// vector of the encoding is ordered [channel][exit row][source coefficient].
struct PrecomputedTransfer {
  int band_count = 0;
  int row_count = 1;
  int channel_count = 1;
  std::string brdf = "lambert";
  std::string mesh_hash;  ///< mesh::mesh_hash of what it was baked for; empty: not known
  cpca::Encoding encoding;
  /// Weights are numbers of the format, as cpca::convert_weights makes them.
  cpca::WeightFormat weight_format = cpca::WeightFormat::float32;
  /// The first cluster of each supercluster, from 0 upwards; empty: every cluster is one.
  std::vector<std::uint32_t> first_clusters = {};
};

/// Bytes that a file stores for it, alignment and padding included.
struct StoredBytes {
  std::size_t cluster_indices, weights, means, bases, tables;  ///< tables: counts, superclusters
  std::size_t total() const { return cluster_indices + weights + means + bases + tables; }
};
StoredBytes stored_bytes(const PrecomputedTransfer& transfer);

}  // namespace prt::gltf
