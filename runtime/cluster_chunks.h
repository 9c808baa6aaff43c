// The chunks of geometry of [Sloan03] §6.2: for each supercluster, all triangles that have at least
// one vertex in it. A triangle between them stands in up to three chunks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gltf/precomputed_transfer.h"

namespace prt::runtime {

/// The first cluster of each chunk to draw: the superclusters of the file, or each cluster by
/// itself, split where their constants (first_constants) exceed `register_limit`. A cluster that
/// alone does is by itself.
std::vector<std::uint32_t> first_clusters_of_chunks(const gltf::PrecomputedTransfer& transfer,
                                                    std::size_t register_limit);

struct ClusterChunks {
  std::vector<std::uint32_t> indices;      ///< three a triangle, chunk after chunk
  std::vector<std::size_t> chunk_offsets;  ///< into `indices`: chunk_count + 1
};

ClusterChunks make_cluster_chunks(std::span<const std::uint32_t> indices,
                                  std::span<const std::uint32_t> chunk_of_vertex,
                                  std::size_t chunk_count);

}  // namespace prt::runtime
