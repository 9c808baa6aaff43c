#include "transfer/hemisphere.h"

namespace prt::transfer {

Hemisphere::Hemisphere(const SceneIndex& index, const Directions& directions)
    : index_(index), directions_(directions), origin_(0.0f) {
  const std::size_t count = directions.count();
  cosines_.resize(count);
  above_.resize(count);
  rays_.resize(count);
  occluded_.resize(count);
  blocked_.resize(count);
}

// Neighbouring directions of one vertex make the fastest packets (bench/ray.cpp). Lists are made
// without branches, which would be mispredicted: what does not belong is overwritten.
void Hemisphere::trace(std::size_t vertex) {
  above_count_ = aim(vertex);
  index_.engine().occluded_from(origin_, {directions_.x, directions_.y, directions_.z},
                                {above_.data(), above_count_}, occluded_);
  blocked_count_ = 0;
  for (std::size_t i = 0; i < above_count_; ++i) {
    blocked_[blocked_count_] = {above_[i], cosines_[above_[i]]};
    blocked_count_ += occluded_[i];
  }
}

std::span<const WeightedRow> Hemisphere::visible() {
  visible_.clear();
  for (std::size_t i = 0; i < above_count_; ++i) {
    if (!occluded_[i]) visible_.push_back({above_[i], cosines_[above_[i]]});
  }
  return visible_;
}

std::size_t Hemisphere::aim(std::size_t vertex) {
  origin_ = index_.ray_origin(vertex);
  const std::size_t count = find_above(index_.normal(vertex));
  rays_cast_ += count;
  return count;
}

std::size_t Hemisphere::find_above(const Vec3& normal) {
  const float *x = directions_.x.data(), *y = directions_.y.data(), *z = directions_.z.data();
  for (std::size_t d = 0; d < cosines_.size(); ++d) {
    cosines_[d] = normal.x * x[d] + normal.y * y[d] + normal.z * z[d];
  }
  std::size_t count = 0;
  for (std::size_t d = 0; d < cosines_.size(); ++d) {
    above_[count] = static_cast<std::uint32_t>(d);
    count += cosines_[d] > 0.0f;
  }
  return count;
}

std::span<const ray::Hit> Hemisphere::hits() {
  hits_.resize(blocked_count_);
  for (std::size_t i = 0; i < blocked_count_; ++i) {
    rays_[i].origin = origin_;
    rays_[i].direction = directions_[blocked_[i].row];
  }
  index_.engine().closest_hit({rays_.data(), blocked_count_}, hits_);
  rays_cast_ += blocked_count_;
  return hits_;
}

}  // namespace prt::transfer
