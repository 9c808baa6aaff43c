#include "runtime/cluster_chunks.h"

namespace prt::runtime {

namespace {

/// Calls visit(cluster) once for each cluster among a triangle's vertices.
template <class Visit>
void for_each_cluster(std::span<const std::uint32_t, 3> triangle,
                      std::span<const std::uint32_t> cluster_of_vertex, Visit visit) {
  const std::uint32_t a = cluster_of_vertex[triangle[0]], b = cluster_of_vertex[triangle[1]],
                      c = cluster_of_vertex[triangle[2]];
  visit(a);
  if (b != a) visit(b);
  if (c != a && c != b) visit(c);
}

}  // namespace

ClusterChunks make_cluster_chunks(std::span<const std::uint32_t> indices,
                                  std::span<const std::uint32_t> cluster_of_vertex,
                                  int cluster_count) {
  ClusterChunks chunks;
  chunks.chunk_offsets.assign(static_cast<std::size_t>(cluster_count) + 1, 0);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    for_each_cluster(indices.subspan(i).first<3>(), cluster_of_vertex,
                     [&](std::uint32_t cluster) { chunks.chunk_offsets[cluster + 1] += 3; });
  for (std::size_t k = 1; k < chunks.chunk_offsets.size(); ++k)
    chunks.chunk_offsets[k] += chunks.chunk_offsets[k - 1];
  chunks.indices.resize(chunks.chunk_offsets.back());
  std::vector<std::size_t> end(chunks.chunk_offsets.begin(), chunks.chunk_offsets.end() - 1);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const auto triangle = indices.subspan(i).first<3>();
    for_each_cluster(triangle, cluster_of_vertex, [&](std::uint32_t cluster) {
      for (const std::uint32_t index : triangle) chunks.indices[end[cluster]++] = index;
    });
  }
  return chunks;
}

double overdraw(const ClusterChunks& chunks, std::size_t index_count) {
  return index_count == 0
             ? 1.0
             : static_cast<double>(chunks.indices.size()) / static_cast<double>(index_count);
}

}  // namespace prt::runtime
