// Pixels as the CPU computes them, to hold rendered ones against.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "ray/engine.h"
#include "runtime/renderer.h"
#include "runtime/shading.h"

namespace prt::runtime {

constexpr int kWidth = 96, kHeight = 64;

/// The pixel that the CPU computes: the camera's ray, its hit, the vertices' exit radiance
/// interpolated.
class CpuPixels {
 public:
  CpuPixels(const Model& model, const View& view, LightField field)
      : model_(model),
        view_(view),
        field_(std::move(field)),
        engine_(ray::make_embree_engine({model.positions, model.indices})) {}

  /// False beside the model and near an edge of its outline, where rasteriser and ray may differ.
  bool radiance(int x, int y, Vec3& radiance) const {
    const ray::Hit hit = closest(x, y);
    if (hit.triangle == ray::kNoHit) return false;
    for (const auto& [dx, dy] : {std::pair(-1, 0), {1, 0}, {0, -1}, {0, 1}}) {
      const ray::Hit beside = closest(x + dx, y + dy);
      if (beside.triangle == ray::kNoHit || std::abs(beside.t - hit.t) > 0.2f) return false;
    }
    radiance = interpolated(&model_.indices[3 * hit.triangle], {1 - hit.u - hit.v, hit.u, hit.v});
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
  std::vector<Vec3> values(std::uint32_t index) const {
    const sh::Light light = light_in(field_, model_.positions[index]);
    return view_.draw == Draw::uncompressed ? exit_values(*model_.signal, index, light)
                                            : exit_values(*model_.transfer, index, light);
  }
  /// The frame that views and coefficients are interpolated in; twin of send_exit.glsl.
  Matrix4 world_from_smooth(std::uint32_t index) const {
    const camera::Camera::Axes axes = view_.camera.axes();
    const Vec3 z = model_.normals[index];
    const Vec3 x =
        axes.right - (axes.backward + z) * (axes.right.dot(z) / (1.0f + axes.backward.dot(z)));
    const Vec3 y = z.cross(x);
    return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, 0, 0, 0, 1};
  }
  /// What the vertex sends where `view`, in the smooth frame, is the direction to the eye.
  Vec3 radiance_of(std::uint32_t index, const Vec3& view) const {
    const Vec3 world = transform_vector(world_from_smooth(index), view);
    const Vec4& tangent = model_.tangents[index];
    const Vec3 x(tangent.x, tangent.y, tangent.z), z = model_.normals[index];
    return exit_radiance(values(index),
                         {x.dot(world), z.cross(x).dot(world) * tangent.w, z.dot(world)});
  }
  Vec3 interpolated(const std::uint32_t* corner, const Vec3& shares) const {
    Vec3 sum(0), view(0);
    if (model_.row_count() == 1) {
      for (int i = 0; i < 3; ++i) sum += values(corner[i])[0] * shares[i];
      return sum;
    }
    for (int i = 0; i < 3; ++i)
      view += transform_vector(world_from_smooth(corner[i]).transposed(),
                               view_.camera.eye - model_.positions[corner[i]]) *
              shares[i];
    view.normalize();
    for (int i = 0; i < 3; ++i) sum += radiance_of(corner[i], view) * shares[i];
    return sum;
  }

  const Model& model_;
  const View& view_;
  LightField field_;
  std::unique_ptr<ray::Engine> engine_;
};

}  // namespace prt::runtime
