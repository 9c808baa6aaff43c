// What a bake keeps in its checkpoint (core/checkpoint.h): what the rays of each block of vertices
// found, the fields of the bounces and, of matrices with bounces, blocks of the output.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

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

/// Restores blocks of kVertexBlock vertices in vertex_order(), and tells how many vertices in
/// `stats` and the log. Returns for each block whether it was there.
std::vector<std::uint8_t> restore_traced(const Checkpoint& checkpoint, const SceneIndex& index,
                                         const TracedRows& traced, DiffuseStats& stats);

/// Keeps the block that begins at place `begin` of vertex_order().
void store_traced(Checkpoint& checkpoint, const SceneIndex& index, const TracedRows& traced,
                  std::size_t begin);

/// Tells in `stats` and the log what share of the bounces need not be done.
void note_resumed_bounces(double share, DiffuseStats& stats);

}  // namespace prt::transfer
