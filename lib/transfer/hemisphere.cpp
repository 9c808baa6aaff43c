#include "transfer/hemisphere.h"

#include <bit>

namespace prt::transfer {

Hemisphere::Hemisphere(const SceneIndex& index, const Directions& directions)
    : index_(index), directions_(directions), origin_(0.0f), normal_(0.0f) {
  const std::size_t count = directions.count();
  lanes_.resize(directions.beams.size());
  rays_.resize(count);
  occluded_.resize(count);
  blocked_.reserve(count);
}

void Hemisphere::trace(std::size_t vertex) {
  trace(index_.ray_origin(vertex), index_.normal(vertex));
}

void Hemisphere::trace(const Vec3& origin, const Vec3& normal) {
  origin_ = origin;
  normal_ = normal;
  if (const ray::ShadowTree* tree = index_.shadow_tree()) {
    tree->trace(origin_, normal_, directions_.beams, lanes_);
  } else {
    trace_by_engine();
  }
  above_count_ = 0;
  for (const ray::BeamLanes& lanes : lanes_) {
    above_count_ += static_cast<std::size_t>(std::popcount(lanes.above));
  }
  rays_cast_ += above_count_;
  list_rows([](const ray::BeamLanes& lanes) { return unsigned{lanes.blocked}; }, blocked_);
}

std::span<const WeightedRow> Hemisphere::visible() {
  list_rows([](const ray::BeamLanes& lanes) { return unsigned{lanes.above} & ~lanes.blocked; },
            visible_);
  return visible_;
}

template <class Choose>
void Hemisphere::list_rows(const Choose& choose, std::vector<WeightedRow>& rows) const {
  rows.clear();
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    for (unsigned chosen = choose(lanes_[i]); chosen != 0; chosen &= chosen - 1) {
      const std::uint32_t row =
          directions_.beams[i].first + static_cast<std::uint32_t>(std::countr_zero(chosen));
      rows.push_back({row, normal_.dot(directions_[row])});
    }
  }
}

void Hemisphere::trace_by_engine() {
  std::size_t count = 0;
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    const ray::Beam& beam = directions_.beams[i];
    lanes_[i] = {};
    for (unsigned lane = 0; lane < beam.lane_count; ++lane) {
      const Vec3 direction = directions_[beam.first + lane];
      if (normal_.dot(direction) <= 0.0f) continue;
      lanes_[i].above |= static_cast<std::uint16_t>(1u << lane);
      rays_[count++] = {origin_, 0.0f, direction};
    }
  }
  index_.engine().occluded({rays_.data(), count}, {occluded_.data(), count});
  count = 0;
  for (ray::BeamLanes& lanes : lanes_) {
    for (unsigned above = lanes.above; above != 0; above &= above - 1) {
      if (occluded_[count++]) lanes.blocked |= static_cast<std::uint16_t>(above & -above);
    }
  }
}

std::span<const ray::Hit> Hemisphere::hits() {
  hits_.resize(blocked_.size());
  for (std::size_t i = 0; i < blocked_.size(); ++i) {
    rays_[i] = {origin_, 0.0f, directions_[blocked_[i].row]};
  }
  index_.engine().closest_hit({rays_.data(), blocked_.size()}, hits_);
  rays_cast_ += blocked_.size();
  return hits_;
}

}  // namespace prt::transfer
