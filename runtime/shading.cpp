#include "runtime/shading.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <span>

namespace prt::runtime {

namespace {

/// t·l for each colour; t is [channel][coefficient].
Vec3 dot_light(std::span<const float> t, int channel_count, const sh::Light& light) {
  Vec3 sum(0.0f);
  for (int color = 0; color < 3; ++color) {
    const std::vector<float>& l = light.coefficients[static_cast<std::size_t>(color)];
    const std::size_t first = channel_count == 3 ? static_cast<std::size_t>(color) * l.size() : 0;
    sum[color] = std::inner_product(l.begin(), l.end(), t.begin() + first, 0.0f);
  }
  return sum;
}

}  // namespace

Vec3 vertex_radiance(const gltf::PrecomputedTransfer& transfer, std::size_t vertex,
                     const sh::Light& light) {
  assert(light.band_count == transfer.band_count);
  const cpca::Encoding& encoding = transfer.encoding;
  const auto cluster = static_cast<int>(encoding.cluster_of_point[vertex]);
  const auto component_count = static_cast<std::size_t>(encoding.component_count);
  const float* const weights = encoding.weights.data() + vertex * component_count;
  Vec3 radiance = dot_light(encoding.mean(cluster), transfer.channel_count, light);
  for (int i = 0; i < encoding.component_count_of(cluster); ++i)
    radiance += weights[i] * dot_light(encoding.basis(cluster, i), transfer.channel_count, light);
  return radiance;
}

Vec3 vertex_radiance(const signal::TransferSignal& signal, std::size_t vertex,
                     const sh::Light& light) {
  assert(light.band_count == signal.band_count);
  const auto dimension = static_cast<std::size_t>(signal.dimension());
  return dot_light(std::span(signal.values).subspan(vertex * dimension, dimension),
                   signal.channel_count, light);
}

Vec3 tone_map(const Vec3& radiance) {
  constexpr float kStart = 0.8f - 0.04f, kDesaturation = 0.15f;
  Vec3 color(std::max(radiance.x, 0.0f), std::max(radiance.y, 0.0f), std::max(radiance.z, 0.0f));
  const float low = std::min({color.x, color.y, color.z});
  color -= Vec3(low < 0.08f ? low - 6.25f * low * low : 0.04f);
  const float peak = std::max({color.x, color.y, color.z});
  if (peak < kStart) return color;
  constexpr float d = 1.0f - kStart;
  const float new_peak = 1.0f - d * d / (peak + d - kStart);
  const float gray = 1.0f - 1.0f / (kDesaturation * (peak - new_peak) + 1.0f);
  return color * (new_peak / peak) * (1.0f - gray) + Vec3(new_peak) * gray;
}

}  // namespace prt::runtime
