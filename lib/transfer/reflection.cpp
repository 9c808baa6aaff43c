#include "transfer/reflection.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/parallel.h"
#include "core/progress.h"

namespace prt::transfer {

namespace {

constexpr float kUnit = 65535.0f;

/// What the trees leave for hits of the 500 MB that diffuse.h promises. Large scenes keep none:
/// their bounces take all coefficients at once, so that hits are traced once a bounce.
std::size_t room_beside_trees(const SceneIndex& index) {
  if (index.is_large()) return 0;
  constexpr std::size_t kTreeBytesPerVertex = 500, kShared = std::size_t{416} << 20,
                        kLeast = std::size_t{16} << 20;
  const std::size_t trees = kTreeBytesPerVertex * index.vertex_count();
  return trees + kLeast < kShared ? kShared - trees : kLeast;
}

std::uint16_t pack_unit(float value) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * kUnit));
}

}  // namespace

Vec3 channel_albedo(const Vec3& albedo, int channel_count) {
  if (channel_count == 3) return albedo;
  return Vec3(0.2126f * albedo.x + 0.7152f * albedo.y + 0.0722f * albedo.z);
}

Reflection::Reflection(const SceneIndex& index, Directions directions, int channel_count,
                       MappedArray<float> blocked, std::size_t hit_bytes)
    : index_(index),
      directions_(std::move(directions)),
      channel_count_(static_cast<std::size_t>(channel_count)),
      blocked_(std::move(blocked)),
      room_(static_cast<std::ptrdiff_t>(std::min(hit_bytes, room_beside_trees(index)) /
                                        sizeof(PackedHit))),
      blocks_(room_ > 0 ? block_count(index.vertex_count(), kVertexBlock) : 0) {}

std::uint64_t Reflection::trace() {
  index_.engine();
  if (blocks_.empty()) return 0;
  Progress progress("bounce rays", index_.vertex_count(), "vertices");
  std::vector<std::uint64_t> rays(blocks_.size());
  parallel_for(index_.vertex_count(), kVertexBlock, [&](std::size_t begin, std::size_t end) {
    if (room_ <= 0) return;
    Block block;
    rays[begin / kVertexBlock] = trace_block(begin, end, block);
    block.hits.shrink_to_fit();
    room_ -= static_cast<std::ptrdiff_t>(block.hits.size());
    block.kept = true;
    blocks_[begin / kVertexBlock] = std::move(block);
    progress.advance(end - begin);
  });
  return std::accumulate(rays.begin(), rays.end(), std::uint64_t{0});
}

std::uint64_t Reflection::trace_block(std::size_t begin, std::size_t end, Block& block) const {
  Hemisphere hemisphere(index_, directions_);
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t vertex = index_.vertex_order()[i];
    hemisphere.trace(vertex);
    block.scales.push_back(pack(vertex, hemisphere, block.hits));
    block.ends.push_back(static_cast<std::uint32_t>(block.hits.size()));
  }
  return hemisphere.rays_cast();
}

float Reflection::pack(std::size_t vertex, Hemisphere& hemisphere,
                       std::vector<PackedHit>& packed) const {
  const std::span<const ray::Hit> hits = hemisphere.hits();
  double cosine_sum = 0.0;  // of all blocked directions, those that end at a black back too
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const ray::Hit& hit = hits[i];
    if (hit.triangle == ray::kNoHit) continue;
    const float cosine = hemisphere.blocked()[i].weight;
    cosine_sum += cosine;
    if (hit.back_face) continue;
    const SceneIndex::Place at = index_.triangle_place(hit.triangle);
    const Vec3 albedo = channel_albedo(
        mesh::albedo_at_point(index_.scene(), index_.scene().primitives[at.primitive], at.local,
                              hit.u, hit.v),
        static_cast<int>(channel_count_));
    packed.push_back({hit.triangle,
                      pack_unit(hit.u),
                      pack_unit(hit.v),
                      pack_unit(cosine),
                      {pack_unit(albedo.x), pack_unit(albedo.y), pack_unit(albedo.z)}});
  }
  return cosine_sum > 0.0 ? static_cast<float>(blocked_[vertex] / cosine_sum) : 0.0f;
}

// Irradiance from reflected radiance albedo/pi · E; `scale` is the solid angle of a direction.
GatherTerm Reflection::unpack(const PackedHit& hit, float scale) const {
  const float weight =
      scale * std::numbers::inv_pi_v<float> * static_cast<float>(hit.cosine) / (kUnit * kUnit);
  const std::array<std::uint32_t, 3> corners = index_.triangle(hit.triangle);
  const float u = hit.u / kUnit, v = hit.v / kUnit;
  return {{corners[0], corners[1], corners[2]},
          {1.0f - u - v, u, v},
          {weight * hit.albedo[0], weight * hit.albedo[1], weight * hit.albedo[2]}};
}

std::uint64_t Reflection::gather(const float* field, std::size_t columns, float* next) const {
  std::vector<std::uint64_t> rays(block_count(index_.vertex_count(), kVertexBlock));
  parallel_for(index_.vertex_count(), kVertexBlock, [&](std::size_t begin, std::size_t end) {
    rays[begin / kVertexBlock] = gather_block(begin, end, field, columns, next);
  });
  return std::accumulate(rays.begin(), rays.end(), std::uint64_t{0});
}

std::uint64_t Reflection::gather_block(std::size_t begin, std::size_t end, const float* field,
                                       std::size_t columns, float* next) const {
  Block traced;
  const Block* block = blocks_.empty() ? &traced : &blocks_[begin / kVertexBlock];
  std::uint64_t rays_cast = 0;
  if (!block->kept) {
    rays_cast = trace_block(begin, end, traced);
    block = &traced;
  }
  std::vector<GatherTerm> terms;
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t first = i == begin ? 0 : block->ends[i - begin - 1];
    terms.clear();
    for (std::size_t h = first; h < block->ends[i - begin]; ++h) {
      terms.push_back(unpack(block->hits[h], block->scales[i - begin]));
    }
    float* row = next + index_.vertex_order()[i] * channel_count_ * columns;
    std::fill_n(row, channel_count_ * columns, 0.0f);
    add_gathered(terms, field, channel_count_, columns, row);
    trim_mapped_arrays();
  }
  return rays_cast;
}

}  // namespace prt::transfer
