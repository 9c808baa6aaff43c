// Interreflection: what the surfaces that block a vertex's rays reflect to it. The hits of the
// first pass are kept, packed, within a memory budget; those of other vertices are traced again.
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
  Reflection(const SceneIndex& index, const Directions& directions, int channel_count,
             std::size_t hit_bytes);

  /// Traces and keeps the hits of the vertex last traced, while there is room. Vertices of a block
  /// (number in vertex_order() / kVertexBlock) come in order, on one thread; finish_block ends it.
  void record(std::size_t block, Hemisphere& hemisphere);
  void finish_block(std::size_t block);

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
    bool kept = true;                 ///< false: did not fit, is traced again
  };

  void pack(const Hemisphere& hemisphere, std::span<const ray::Hit> hits,
            std::vector<PackedHit>& packed) const;
  GatherTerm unpack(const PackedHit& hit) const;
  std::uint64_t gather_block(std::size_t begin, std::size_t end, const float* field,
                             std::size_t columns, float* next) const;

  const SceneIndex& index_;
  const Directions& directions_;
  std::size_t channel_count_;
  std::vector<Block> blocks_;
  std::atomic<std::ptrdiff_t> room_;  ///< hits that still fit
};

}  // namespace prt::transfer
