#include "transfer/reflection.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"

namespace prt::transfer {

namespace {

constexpr float kUnit = 65535.0f;

std::uint16_t pack_unit(float value) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * kUnit));
}

}  // namespace

Vec3 channel_albedo(const Vec3& albedo, int channel_count) {
  if (channel_count == 3) return albedo;
  return Vec3(0.2126f * albedo.x + 0.7152f * albedo.y + 0.0722f * albedo.z);
}

Reflection::Reflection(const SceneIndex& index, const Directions& directions, int channel_count,
                       std::size_t hit_bytes)
    : index_(index),
      directions_(directions),
      channel_count_(static_cast<std::size_t>(channel_count)),
      blocks_(block_count(index.vertex_count(), kVertexBlock)),
      room_(static_cast<std::ptrdiff_t>(hit_bytes / sizeof(PackedHit))) {}

void Reflection::pack(const Hemisphere& hemisphere, std::span<const ray::Hit> hits,
                      std::vector<PackedHit>& packed) const {
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const ray::Hit& hit = hits[i];
    if (hit.triangle == ray::kNoHit || hit.back_face) continue;
    const SceneIndex::Place at = index_.triangle_place(hit.triangle);
    const Vec3 albedo = channel_albedo(
        mesh::albedo_at_point(index_.scene(), index_.scene().primitives[at.primitive], at.local,
                              hit.u, hit.v),
        static_cast<int>(channel_count_));
    packed.push_back({hit.triangle,
                      pack_unit(hit.u),
                      pack_unit(hit.v),
                      pack_unit(hemisphere.blocked()[i].weight),
                      {pack_unit(albedo.x), pack_unit(albedo.y), pack_unit(albedo.z)}});
  }
}

GatherTerm Reflection::unpack(const PackedHit& hit) const {
  // Irradiance from reflected radiance albedo/pi · E, in a direction of weight 4 pi / count.
  const float scale = 4.0f / static_cast<float>(directions_.count()) * hit.cosine / (kUnit * kUnit);
  const std::array<std::uint32_t, 3> corners = index_.triangle(hit.triangle);
  const float u = hit.u / kUnit, v = hit.v / kUnit;
  return {{corners[0], corners[1], corners[2]},
          {1.0f - u - v, u, v},
          {scale * hit.albedo[0], scale * hit.albedo[1], scale * hit.albedo[2]}};
}

void Reflection::record(std::size_t block, Hemisphere& hemisphere) {
  Block& mine = blocks_[block];
  if (room_ <= 0) mine.kept = false;
  if (!mine.kept) return;
  pack(hemisphere, hemisphere.hits(), mine.hits);
  mine.ends.push_back(static_cast<std::uint32_t>(mine.hits.size()));
}

void Reflection::finish_block(std::size_t block) {
  Block& mine = blocks_[block];
  if (!mine.kept) mine = {{}, {}, false};
  mine.hits.shrink_to_fit();
  room_ -= static_cast<std::ptrdiff_t>(mine.hits.size());
}

std::uint64_t Reflection::gather(const float* field, std::size_t columns, float* next) const {
  std::vector<std::uint64_t> rays(blocks_.size());
  parallel_for(index_.vertex_count(), kVertexBlock, [&](std::size_t begin, std::size_t end) {
    rays[begin / kVertexBlock] = gather_block(begin, end, field, columns, next);
  });
  return std::accumulate(rays.begin(), rays.end(), std::uint64_t{0});
}

std::uint64_t Reflection::gather_block(std::size_t begin, std::size_t end, const float* field,
                                       std::size_t columns, float* next) const {
  const Block& block = blocks_[begin / kVertexBlock];
  Hemisphere hemisphere(index_, directions_);
  std::vector<PackedHit> traced;
  std::vector<GatherTerm> terms;
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t vertex = index_.vertex_order()[i];
    std::span<const PackedHit> hits;
    if (block.kept) {
      const std::size_t first = i == begin ? 0 : block.ends[i - begin - 1];
      hits = {block.hits.data() + first, block.ends[i - begin] - first};
    } else {
      hemisphere.trace(vertex);
      traced.clear();
      pack(hemisphere, hemisphere.hits(), traced);
      hits = traced;
    }
    terms.clear();
    for (const PackedHit& hit : hits) terms.push_back(unpack(hit));
    float* row = next + vertex * channel_count_ * columns;
    std::fill_n(row, channel_count_ * columns, 0.0f);
    add_gathered(terms, field, channel_count_, columns, row);
  }
  return hemisphere.rays_cast();
}

}  // namespace prt::transfer
