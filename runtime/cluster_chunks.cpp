#include "runtime/cluster_chunks.h"

#include <algorithm>

#include "cpca/overdraw.h"
#include "runtime/cluster_constants.h"

namespace prt::runtime {

std::vector<std::uint32_t> first_clusters_of_chunks(const gltf::PrecomputedTransfer& transfer,
                                                    std::size_t register_limit) {
  const std::vector<std::uint32_t> constants = first_constants(transfer.encoding);
  const std::vector<std::uint32_t>& superclusters = transfer.first_clusters;
  std::vector<std::uint32_t> first;
  for (std::uint32_t k = 0; k + 1 < constants.size(); ++k) {
    const bool begins =
        superclusters.empty() || std::binary_search(superclusters.begin(), superclusters.end(), k);
    if (begins || constants[k + 1] - constants[first.back()] > register_limit) first.push_back(k);
  }
  return first;
}

ClusterChunks make_cluster_chunks(std::span<const std::uint32_t> indices,
                                  std::span<const std::uint32_t> chunk_of_vertex,
                                  std::size_t chunk_count) {
  const auto for_each_chunk = [&](std::size_t first_index, auto visit) {
    cpca::for_each_label(chunk_of_vertex[indices[first_index]],
                         chunk_of_vertex[indices[first_index + 1]],
                         chunk_of_vertex[indices[first_index + 2]], visit);
  };
  ClusterChunks chunks;
  chunks.chunk_offsets.assign(chunk_count + 1, 0);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    for_each_chunk(i, [&](std::uint32_t chunk) { chunks.chunk_offsets[chunk + 1] += 3; });
  for (std::size_t k = 1; k < chunks.chunk_offsets.size(); ++k)
    chunks.chunk_offsets[k] += chunks.chunk_offsets[k - 1];
  chunks.indices.resize(chunks.chunk_offsets.back());
  std::vector<std::size_t> end(chunks.chunk_offsets.begin(), chunks.chunk_offsets.end() - 1);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    for_each_chunk(i, [&](std::uint32_t chunk) {
      for (const std::uint32_t index : indices.subspan(i, 3)) {
        chunks.indices[end[chunk]++] = index;
      }
    });
  }
  return chunks;
}

}  // namespace prt::runtime
