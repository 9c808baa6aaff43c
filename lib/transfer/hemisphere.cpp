#include "transfer/hemisphere.h"

namespace prt::transfer {

Hemisphere::Hemisphere(const SceneIndex& index, const Directions& directions)
    : index_(index), directions_(directions), origin_(0.0f) {
  rays_.resize(directions.count());
  above_.resize(directions.count());
  occluded_.resize(directions.count());
}

void Hemisphere::trace(std::size_t vertex) {
  const Vec3 normal = index_.normal(vertex);
  origin_ = index_.ray_origin(vertex);
  // Neighbouring directions of one vertex make the fastest packets (bench/ray.cpp). Every ray is
  // written and those below the horizon are overwritten: no branch to mispredict.
  std::size_t count = 0;
  for (std::size_t d = 0; d < directions_.count(); ++d) {
    const Vec3 direction = directions_[d];
    const float cosine = normal.dot(direction);
    rays_[count] = {origin_, 0.0f, direction};
    above_[count] = {static_cast<std::uint32_t>(d), cosine};
    count += cosine > 0.0f;
  }
  index_.engine().occluded({rays_.data(), count}, {occluded_.data(), count},
                           ray::Coherence::coherent);
  rays_cast_ += count;
  blocked_.clear();
  visible_.clear();
  for (std::size_t i = 0; i < count; ++i) (occluded_[i] ? blocked_ : visible_).push_back(above_[i]);
}

std::span<const ray::Hit> Hemisphere::hits() {
  hits_.resize(blocked_.size());
  for (std::size_t i = 0; i < blocked_.size(); ++i) {
    rays_[i] = {origin_, 0.0f, directions_[blocked_[i].row]};
  }
  index_.engine().closest_hit({rays_.data(), blocked_.size()}, hits_, ray::Coherence::coherent);
  rays_cast_ += blocked_.size();
  return hits_;
}

}  // namespace prt::transfer
