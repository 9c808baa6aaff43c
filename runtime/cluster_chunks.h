// The chunks of geometry of [Sloan03] §6.2: for each cluster, all triangles that have at least one
// vertex in it. A triangle between clusters stands in up to three chunks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt::runtime {

struct ClusterChunks {
  std::vector<std::uint32_t> indices;      ///< three a triangle, chunk after chunk
  std::vector<std::size_t> chunk_offsets;  ///< into `indices`: cluster_count + 1
};

ClusterChunks make_cluster_chunks(std::span<const std::uint32_t> indices,
                                  std::span<const std::uint32_t> cluster_of_vertex,
                                  int cluster_count);

}  // namespace prt::runtime
