#include "transfer/resume.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

#include "core/log.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "transfer/reflection.h"

namespace prt::transfer {

namespace {

std::span<const std::uint32_t> block_vertices(const SceneIndex& index, std::size_t begin) {
  return index.vertex_order().subspan(begin, std::min(kVertexBlock, index.vertex_count() - begin));
}

Checkpoint::Name block_name(std::size_t begin) {
  return {kTraceStage, static_cast<std::uint32_t>(begin / kVertexBlock)};
}

/// Returns for each block whether it was there.
std::vector<std::uint8_t> restore_traced(const Checkpoint& checkpoint, const SceneIndex& index,
                                         const TracedRows& traced, DiffuseStats& stats) {
  std::vector<std::uint8_t> restored(block_count(index.vertex_count(), kVertexBlock));
  for (std::size_t block = 0; block < restored.size(); ++block) {
    const std::size_t begin = block * kVertexBlock;
    const auto vertices = block_vertices(index, begin);
    std::vector<float> values(vertices.size() * (traced.count + 1));
    if (!checkpoint.restore(block_name(begin), std::span(values))) continue;
    const float* from = values.data();
    for (const std::uint32_t vertex : vertices) {
      std::copy_n(from, traced.count, traced.rows + vertex * traced.stride);
      traced.buried[vertex] = from[traced.count] != 0.0f;
      from += traced.count + 1;
    }
    trim_mapped_arrays();
    restored[block] = 1;
    stats.resumed_vertex_count += vertices.size();
  }
  if (stats.resumed_vertex_count > 0) {
    log::info("continuing an interrupted run, which traced {:.0f}% of the vertices",
              100.0 * static_cast<double>(stats.resumed_vertex_count) /
                  static_cast<double>(index.vertex_count()));
  }
  return restored;
}

void store_traced(Checkpoint& checkpoint, const SceneIndex& index, const TracedRows& traced,
                  std::size_t begin) {
  std::vector<float> values;
  for (const std::uint32_t vertex : block_vertices(index, begin)) {
    const float* row = traced.rows + vertex * traced.stride;
    values.insert(values.end(), row, row + traced.count);
    values.push_back(traced.buried[vertex]);
  }
  checkpoint.store(block_name(begin), std::span<const float>(values));
}

}  // namespace

std::uint64_t trace_vertices(Checkpoint& checkpoint, const SceneIndex& index,
                             const TracedRows& traced, const char* name, int ray_count,
                             const TraceBlock& trace_block, DiffuseStats& stats) {
  const auto rays_of_vertex = static_cast<std::size_t>(ray_count);
  const std::vector<std::uint8_t> restored = restore_traced(checkpoint, index, traced, stats);
  std::vector<std::uint64_t> rays(restored.size());
  Progress progress(name, index.vertex_count() * rays_of_vertex, "rays");
  parallel_for(index.vertex_count(), kVertexBlock, [&](std::size_t begin, std::size_t end) {
    if (!restored[begin / kVertexBlock]) {
      rays[begin / kVertexBlock] = trace_block(begin, end);
      store_traced(checkpoint, index, traced, begin);
    }
    progress.advance((end - begin) * rays_of_vertex);
  });
  return std::accumulate(rays.begin(), rays.end(), std::uint64_t{0});
}

void note_resumed_bounces(double share, DiffuseStats& stats) {
  stats.resumed_bounce_share = share;
  if (share > 0.0) {
    log::info("continuing an interrupted run, which did {:.0f}% of the bounces", 100.0 * share);
  }
}

}  // namespace prt::transfer
