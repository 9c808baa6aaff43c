// Pixels as the CPU computes them, to hold rendered ones against.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include "ray/engine.h"
#include "runtime/renderer.h"
#include "runtime/shading.h"

namespace prt::runtime {

constexpr int kWidth = 96, kHeight = 64;

/// The pixel that the CPU computes: the camera's ray, its hit, the vertices' radiance interpolated.
class CpuPixels {
 public:
  CpuPixels(const Model& model, const View& view, const sh::Light& light)
      : model_(model),
        view_(view),
        light_(light),
        engine_(ray::make_embree_engine({model.positions, model.indices})) {}

  /// False beside the model and near an edge of its outline, where rasteriser and ray may differ.
  bool radiance(int x, int y, Vec3& radiance) const {
    const ray::Hit hit = closest(x, y);
    if (hit.triangle == ray::kNoHit) return false;
    for (const auto& [dx, dy] : {std::pair(-1, 0), {1, 0}, {0, -1}, {0, 1}}) {
      const ray::Hit beside = closest(x + dx, y + dy);
      if (beside.triangle == ray::kNoHit || std::abs(beside.t - hit.t) > 0.2f) return false;
    }
    const std::uint32_t* const corner = &model_.indices[3 * hit.triangle];
    radiance = vertex(corner[0]) * (1 - hit.u - hit.v) + vertex(corner[1]) * hit.u +
               vertex(corner[2]) * hit.v;
    return true;
  }

 private:
  ray::Hit closest(int x, int y) const {
    ray::Ray ray;
    ray.origin = view_.camera.eye;
    ray.direction = view_.camera.ray_direction((2 * static_cast<float>(x) + 1) / kWidth - 1,
                                               1 - (2 * static_cast<float>(y) + 1) / kHeight);
    ray::Hit hit;
    engine_->closest_hit({&ray, 1}, {&hit, 1});
    return hit;
  }
  Vec3 vertex(std::uint32_t index) const {
    return view_.draw == Draw::uncompressed ? vertex_radiance(*model_.signal, index, light_)
                                            : vertex_radiance(*model_.transfer, index, light_);
  }

  const Model& model_;
  const View& view_;
  const sh::Light& light_;
  std::unique_ptr<ray::Engine> engine_;
};

}  // namespace prt::runtime
