#include "runtime/cluster_chunks.h"

#include "cpca/overdraw.h"

namespace prt::runtime {

ClusterChunks make_cluster_chunks(std::span<const std::uint32_t> indices,
                                  std::span<const std::uint32_t> cluster_of_vertex,
                                  int cluster_count) {
  const auto for_each_chunk = [&](std::size_t first_index, auto visit) {
    cpca::for_each_label(cluster_of_vertex[indices[first_index]],
                         cluster_of_vertex[indices[first_index + 1]],
                         cluster_of_vertex[indices[first_index + 2]], visit);
  };
  ClusterChunks chunks;
  chunks.chunk_offsets.assign(static_cast<std::size_t>(cluster_count) + 1, 0);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    for_each_chunk(i, [&](std::uint32_t cluster) { chunks.chunk_offsets[cluster + 1] += 3; });
  for (std::size_t k = 1; k < chunks.chunk_offsets.size(); ++k)
    chunks.chunk_offsets[k] += chunks.chunk_offsets[k - 1];
  chunks.indices.resize(chunks.chunk_offsets.back());
  std::vector<std::size_t> end(chunks.chunk_offsets.begin(), chunks.chunk_offsets.end() - 1);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    for_each_chunk(i, [&](std::uint32_t cluster) {
      for (const std::uint32_t index : indices.subspan(i, 3)) {
        chunks.indices[end[cluster]++] = index;
      }
    });
  }
  return chunks;
}

}  // namespace prt::runtime
