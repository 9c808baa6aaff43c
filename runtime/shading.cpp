#include "runtime/shading.h"

#include <algorithm>
#include <array>
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

Vec3 heat_color(float t) {
  static const std::array<Vec3, 5> stops = {Vec3(0, 0, 1), Vec3(0, 1, 1), Vec3(0, 1, 0),
                                            Vec3(1, 1, 0), Vec3(1, 0, 0)};
  const float position = std::clamp(t, 0.0f, 1.0f) * 4.0f;
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(position), 3);
  const float f = position - static_cast<float>(i);
  return stops[i] * (1.0f - f) + stops[i + 1] * f;
}

Vec3 cluster_color(std::size_t cluster) {
  // Hues advance by the golden ratio, which keeps any run of them apart; brightness and saturation
  // take turns.
  const double golden = 0.6180339887498949 * static_cast<double>(cluster);
  const auto hue = static_cast<float>(golden - std::floor(golden)) * 6.0f;
  const float value = cluster % 2 == 0 ? 0.9f : 0.5f, saturation = cluster % 3 == 0 ? 0.6f : 0.9f;
  const auto ramp = [&](float offset) {
    const float k = std::fmod(offset + hue, 6.0f);
    return value * (1.0f - saturation * std::clamp(std::min(k, 4.0f - k), 0.0f, 1.0f));
  };
  return {ramp(5.0f), ramp(3.0f), ramp(1.0f)};
}

}  // namespace prt::runtime
