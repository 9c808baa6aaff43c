// Interreflection: what the surfaces around a vertex reflect to it. Radiance between surfaces
// varies slowly beside the edges of the light, so this takes a smaller set of directions than
// shadows do. Their hits are traced once and kept, packed, within a memory budget; those of other
// vertices, and of large scenes, are traced again for every bounce.
//
// The small set sees a slightly other share of the hemisphere blocked than the shadow rays did.
// Each vertex's sum is scaled to their share, so that blocked and reflected energy balance exactly.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "transfer/hemisphere.h"
#include "transfer/scene_index.h"

namespace prt::transfer {

constexpr std::size_t kVertexBlock = 64;  ///< vertices of a parallel block, in vertex_order()

/// Albedo as the transfer sees it: one channel takes the luminance (Rec. 709).
Vec3 channel_albedo(const Vec3& albedo, int channel_count);

class Reflection {
 public:
  /// `blocked`: ∫ (1 - V) max(0, cos) of every vertex, as the shadow rays found it. Hits take
  /// hit_bytes at most, less where the trees of rays take much memory.
  Reflection(const SceneIndex& index, Directions directions, int channel_count,
             MappedArray<float> blocked, std::size_t hit_bytes);

  /// Traces all vertices and keeps their hits while there is room. Returns the number of rays cast.
  std::uint64_t trace();

  /// One bounce: next_v = ∫ reflected albedo/pi · field. Fields have columns floats a channel,
  /// channel after channel, a row a vertex. Returns the number of rays cast.
  std::uint64_t gather(const float* field, std::size_t columns, float* next) const;

 private:
  /// 16 bits each, rounded: the error is far below that of the directions.
  struct PackedHit {
    std::uint32_t triangle;
    std::uint16_t u, v, cosine, albedo[3];
  };
  struct Block {
    std::vector<PackedHit> hits;
    std::vector<std::uint32_t> ends;  ///< of each vertex's hits
    std::vector<float> scales;        ///< of each vertex's sum
    bool kept = false;                ///< false: did not fit, is traced again
  };

  /// Traces the vertices [begin, end) of vertex_order(). Returns the number of rays cast.
  std::uint64_t trace_block(std::size_t begin, std::size_t end, Block& block) const;
  /// Appends hits of the vertex last traced; returns the scale of its sum.
  float pack(std::size_t vertex, Hemisphere& hemisphere, std::vector<PackedHit>& packed) const;
  GatherTerm unpack(const PackedHit& hit, float scale) const;
  std::uint64_t gather_block(std::size_t begin, std::size_t end, const float* field,
                             std::size_t columns, float* next) const;

  const SceneIndex& index_;
  Directions directions_;
  std::size_t channel_count_;
  MappedArray<float> blocked_;
  std::atomic<std::ptrdiff_t> room_;  ///< hits that still fit
  std::vector<Block> blocks_;         ///< none when none fit
};

}  // namespace prt::transfer
