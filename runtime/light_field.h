// Light that differs from place to place. Transfer takes light as distant, the same all over the
// model; what a near light sends is not. It is sampled at points of a grid over the model, at each
// of them taken as distant, and blended between them ([Sloan03] §6; [Sloan02] samples radiance near
// the object alike). How a model shadows itself from a near light is thereby that of a distant one.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/vec.h"
#include "gl/program.h"
#include "sh/light.h"

namespace prt::runtime {

/// A sphere of constant radiance, or a point.
struct NearLight {
  Vec3 position{0.0f};
  float radius = 0.0f;  ///< 0: a point
  Vec3 color{0.0f};     ///< radiance; of a point, irradiance at distance 1 on a facing surface
};

/// X,Y,Z,R,G,B: a point; X,Y,Z,RADIUS,R,G,B: a sphere. Throws Error (usage) for another count, for
/// numbers that are not finite and for a radius that is not positive.
NearLight near_light(std::span<const float> numbers);

/// What arrives at a point, as distant light: of a sphere the disk that it covers there, inside of
/// it its radiance from everywhere; of a point a direction.
sh::Light light_at(std::span<const NearLight> lights, int band_count, const Vec3& point);

constexpr int kMaxGridSize = 8;

/// size³ points, x fastest, from one corner of a box to the opposite one; size 1: its middle.
struct LightGrid {
  int size = 1;
  Vec3 low{0.0f}, high{0.0f};

  std::size_t point_count() const;
  /// Of a point in grid steps, and in the world.
  Vec3 place(std::size_t number) const;
  Vec3 point(std::size_t number) const;
  /// Grid steps in a unit of length along each axis; 0 where the box has no extent.
  Vec3 steps_per_unit() const;
  /// Uniforms of light_field.glsl of the program in use.
  void bind(const gl::Program& program) const;
};

/// Light at the points of a grid, all of the same bands; of size 1, one light everywhere.
struct LightField {
  LightGrid grid;
  std::vector<sh::Light> samples;

  bool varies() const { return samples.size() > 1; }
};

/// The distant light and what arrives from the near ones, on `grid` if there are any.
LightField light_field(const sh::Light& distant, std::span<const NearLight> near,
                       const LightGrid& grid);

/// The samples that a vertex blends, as #defines of shaders: one, or the eight around it.
gl::Defines light_field_defines(bool varies);

/// Blended at a point: twin of light_field.glsl.
sh::Light light_in(const LightField& field, const Vec3& point);

}  // namespace prt::runtime
