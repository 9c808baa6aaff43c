// The distant light that a path tracer sees: radiance by direction, and directions worth asking
// for.
#pragma once

#include <span>

#include "core/vec.h"
#include "image/environment.h"
#include "image/image.h"
#include "sh/light.h"

namespace prt::reference {

class Illumination {
 public:
  virtual ~Illumination() = default;

  /// Radiance (linear RGB; a band-limited light's may be negative) from each unit direction.
  virtual void radiance(std::span<const Vec3> directions, std::span<Vec3> radiance) const = 0;

  /// Whether sample() and pdf() are worth their rays: false for smooth lights, which cosine
  /// weighted directions alone serve better.
  virtual bool is_peaked() const { return false; }

  using Sample = image::EnvironmentSampler::Sample;
  /// A direction drawn in proportion to luminance, and its density per steradian.
  virtual Sample sample(const Vec2&) const { return {}; }
  virtual float pdf(const Vec3&) const { return 0.0f; }
};

/// The light of `--light-mode band-limited`: what precomputed transfer sees.
class BandLimitedIllumination : public Illumination {
 public:
  explicit BandLimitedIllumination(const sh::Light& light) : light_(light) {}
  void radiance(std::span<const Vec3> directions, std::span<Vec3> radiance) const override;

 private:
  sh::Light light_;
};

/// The light of `--light-mode full`: a whole map, turned as sh::rotated() turns a light. Keeps a
/// reference to the map.
class EnvironmentIllumination : public Illumination {
 public:
  explicit EnvironmentIllumination(const image::Image& environment,
                                   const Matrix4& world_from_light = Matrix4());
  void radiance(std::span<const Vec3> directions, std::span<Vec3> radiance) const override;
  bool is_peaked() const override { return true; }
  Sample sample(const Vec2& u) const override;
  float pdf(const Vec3& direction) const override;

 private:
  const image::Image& environment_;
  image::EnvironmentSampler sampler_;
  Matrix4 world_from_light_, light_from_world_;
};

}  // namespace prt::reference
