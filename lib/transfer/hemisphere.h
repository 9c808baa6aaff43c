// What a vertex sees: traces the shared directions above its horizon.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ray/engine.h"
#include "transfer/directions.h"
#include "transfer/kernels.h"
#include "transfer/scene_index.h"

namespace prt::transfer {

/// Buffers of one thread, used for vertex after vertex.
class Hemisphere {
 public:
  Hemisphere(const SceneIndex& index, const Directions& directions);

  /// Casts a shadow ray in each direction above the vertex's horizon. Once the index has given its
  /// shadow tree back, by its engine, which is slower.
  void trace(std::size_t vertex);
  /// The same of any point, as of index.ray_origin().
  void trace(const Vec3& origin, const Vec3& normal);
  /// Those that are blocked: direction number and cosine, in the order of the directions.
  std::span<const WeightedRow> blocked() const { return blocked_; }
  /// The others.
  std::span<const WeightedRow> visible();
  std::size_t visible_count() const { return above_count_ - blocked_.size(); }

  /// Closest hits of the blocked rays of the vertex last traced, parallel to blocked(). Whether
  /// anything is hit is much faster to find out first. kNoHit where the two disagree, along edges.
  std::span<const ray::Hit> hits();

  /// Rays cast so far, of both kinds.
  std::uint64_t rays_cast() const { return rays_cast_; }

 private:
  /// Sets lanes_, by the ray engine instead of the shadow tree.
  void trace_by_engine();
  template <class Choose>
  void list_rows(const Choose& choose, std::vector<WeightedRow>& rows) const;

  const SceneIndex& index_;
  const Directions& directions_;
  Vec3 origin_, normal_;
  std::vector<ray::BeamLanes> lanes_;  ///< of the vertex last given to trace
  std::vector<ray::Ray> rays_;
  std::vector<WeightedRow> blocked_, visible_;
  std::size_t above_count_ = 0;
  std::vector<ray::Hit> hits_;
  std::vector<std::uint8_t> occluded_;
  std::uint64_t rays_cast_ = 0;
};

}  // namespace prt::transfer
