#include "transfer/hemisphere.h"

#include <bit>

namespace prt::transfer {

Hemisphere::Hemisphere(const SceneIndex& index, const Directions& directions)
    : index_(index), directions_(directions), origin_(0.0f), normal_(0.0f) {
  const std::size_t count = directions.count();
  lanes_.resize(directions.beams.size());
  cosines_.resize(count);
  above_.resize(count);
  rays_.resize(count);
  blocked_.reserve(count);
}

void Hemisphere::trace(std::size_t vertex) {
  origin_ = index_.ray_origin(vertex);
  normal_ = index_.normal(vertex);
  index_.shadow_tree().trace(origin_, normal_, directions_.beams, lanes_);
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

// The list is made without branches, which would be mispredicted: what does not belong is
// overwritten.
std::size_t Hemisphere::aim(std::size_t vertex) {
  origin_ = index_.ray_origin(vertex);
  normal_ = index_.normal(vertex);
  const float *x = directions_.x.data(), *y = directions_.y.data(), *z = directions_.z.data();
  for (std::size_t d = 0; d < cosines_.size(); ++d) {
    cosines_[d] = normal_.x * x[d] + normal_.y * y[d] + normal_.z * z[d];
  }
  std::size_t count = 0;
  for (std::size_t d = 0; d < cosines_.size(); ++d) {
    above_[count] = static_cast<std::uint32_t>(d);
    count += cosines_[d] > 0.0f;
  }
  rays_cast_ += count;
  return count;
}

std::span<const ray::Hit> Hemisphere::hits() {
  hits_.resize(blocked_.size());
  for (std::size_t i = 0; i < blocked_.size(); ++i) {
    rays_[i].origin = origin_;
    rays_[i].direction = directions_[blocked_[i].row];
  }
  index_.engine().closest_hit({rays_.data(), blocked_.size()}, hits_);
  rays_cast_ += blocked_.size();
  return hits_;
}

}  // namespace prt::transfer
