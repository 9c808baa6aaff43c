// What a bake keeps in its checkpoint (core/checkpoint.h): what the rays of each block of vertices
// found, the fields of the bounces and, of matrices with bounces, blocks of the output.
#pragma once

#include <cstdint>
#include <functional>

#include "core/checkpoint.h"
#include "transfer/diffuse.h"
#include "transfer/scene_index.h"

namespace prt::transfer {

enum Stage : std::uint32_t {
  kTraceStage,
  kBounceStage,
  kOutputStage,
  kFieldStage  ///< of matrices: field_stage(0)
};

/// Of the field of so many bounces.
constexpr std::uint32_t field_stage(int bounce_count) {
  return kFieldStage + static_cast<std::uint32_t>(bounce_count);
}

/// The first `count` of the `stride` values of each vertex's row, and whether it is buried.
struct TracedRows {
  float* rows;
  std::size_t stride, count;
  std::uint8_t* buried;
};

/// Writes the rows and marks of the vertices at [begin, end) of vertex_order(); returns rays cast.
using TraceBlock = std::function<std::uint64_t(std::size_t begin, std::size_t end)>;

/// All vertices, by blocks of kVertexBlock: those that the checkpoint has are restored, which
/// `stats` and the log tell, the others traced and kept. `name` is that of the progress, in
/// `ray_count` rays a vertex. Returns the rays of this run.
std::uint64_t trace_vertices(Checkpoint& checkpoint, const SceneIndex& index,
                             const TracedRows& traced, const char* name, int ray_count,
                             const TraceBlock& trace_block, DiffuseStats& stats);

/// Tells in `stats` and the log what share of the bounces need not be done.
void note_resumed_bounces(double share, DiffuseStats& stats);

}  // namespace prt::transfer
