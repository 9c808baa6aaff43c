#include "ray/wide_engine.h"

#include <cassert>

namespace prt::ray {

namespace {

constexpr std::size_t kRaysPerTrim = 1024;

class WideEngine final : public Engine {
 public:
  WideEngine(std::shared_ptr<const WideTree> tree, SimdLevel level)
      : tree_(std::move(tree)),
        find_closest_(
            kernel_for(level, find_closest_avx512, find_closest_avx2, find_closest_baseline)),
        is_occluded_(
            kernel_for(level, is_occluded_avx512, is_occluded_avx2, is_occluded_baseline)) {}

  void closest_hit(std::span<const Ray> rays, std::span<Hit> hits) const override {
    assert(hits.size() == rays.size());
    for_each_query(rays, [&](const RayQuery& query, std::size_t i) {
      const RayAnswer answer = find_closest_(tree_->view(), query);
      hits[i] = answer.triangle == kNoHit ? Hit{}
                                          : Hit{answer.triangle, answer.t / tree_->scale(),
                                                answer.u, answer.v, answer.back_face};
    });
  }

  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded) const override {
    assert(occluded.size() == rays.size());
    for_each_query(rays, [&](const RayQuery& query, std::size_t i) {
      occluded[i] = is_occluded_(tree_->view(), query);
    });
  }

 private:
  template <class Body>
  void for_each_query(std::span<const Ray> rays, const Body& body) const {
    const float scale = tree_->scale();
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Ray& ray = rays[i];
      const Vec3 o = ray.origin * scale, d = ray.direction;
      body({{o.x, o.y, o.z}, {d.x, d.y, d.z}, ray.t_near * scale, ray.t_far * scale}, i);
      if (i % kRaysPerTrim == kRaysPerTrim - 1) trim_mapped_arrays();
    }
    trim_mapped_arrays();
  }

  std::shared_ptr<const WideTree> tree_;
  RayAnswer (*find_closest_)(const WideTreeView&, const RayQuery&);
  bool (*is_occluded_)(const WideTreeView&, const RayQuery&);
};

}  // namespace

std::unique_ptr<Engine> make_wide_engine(std::shared_ptr<const WideTree> tree, SimdLevel level) {
  return std::make_unique<WideEngine>(std::move(tree), level);
}

}  // namespace prt::ray
