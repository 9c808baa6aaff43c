#include "reference/illumination.h"

#include <algorithm>
#include <array>

#include "sh/basis.h"

namespace prt::reference {

namespace {
constexpr std::size_t kBlock = 64;  // directions evaluated together; 64 KiB of stack at 16 bands
}

void BandLimitedIllumination::radiance(std::span<const Vec3> directions,
                                       std::span<Vec3> radiance) const {
  std::array<float, kBlock> x, y, z;
  std::array<float, kBlock * sh::row_size(sh::kMaxBandCount)> basis;
  const auto coefficient_count = sh::row_size(light_.band_count);
  for (std::size_t begin = 0; begin < directions.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, directions.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      x[i] = directions[begin + i].x;
      y[i] = directions[begin + i].y;
      z[i] = directions[begin + i].z;
    }
    sh::evaluate_batch(light_.band_count, x.data(), y.data(), z.data(), count, basis.data(),
                       kBlock);
    std::array<std::array<float, kBlock>, 3> sums{};
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < coefficient_count; ++k) {
        const float coefficient = light_.coefficients[c][k];
        const float* values = basis.data() + k * kBlock;
        for (std::size_t i = 0; i < count; ++i) sums[c][i] += coefficient * values[i];
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      radiance[begin + i] = {sums[0][i], sums[1][i], sums[2][i]};
    }
  }
}

EnvironmentIllumination::EnvironmentIllumination(const image::Image& environment,
                                                 const Matrix4& world_from_light)
    : environment_(environment),
      sampler_(environment),
      world_from_light_(world_from_light),
      light_from_world_(world_from_light.transposed()) {}

void EnvironmentIllumination::radiance(std::span<const Vec3> directions,
                                       std::span<Vec3> radiance) const {
  for (std::size_t i = 0; i < directions.size(); ++i) {
    radiance[i] = image::environment_radiance(environment_,
                                              transform_vector(light_from_world_, directions[i]));
  }
}

Illumination::Sample EnvironmentIllumination::sample(const Vec2& u) const {
  Sample sample = sampler_.sample(u.x, u.y);
  sample.direction = transform_vector(world_from_light_, sample.direction);
  return sample;
}

float EnvironmentIllumination::pdf(const Vec3& direction) const {
  return sampler_.pdf(transform_vector(light_from_world_, direction));
}

}  // namespace prt::reference
