// What a bake keeps in its checkpoint (core/checkpoint.h): what the rays of each block of vertices
// found, and the fields of the bounces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/checkpoint.h"
#include "transfer/diffuse.h"
#include "transfer/scene_index.h"

namespace prt::transfer {

enum Stage : std::uint32_t { kTraceStage, kBounceStage };

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

}  // namespace prt::transfer
