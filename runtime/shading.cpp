#include "runtime/shading.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <span>

#include "sh/basis.h"
#include "sh/hemisphere.h"

namespace prt::runtime {

namespace {

/// Adds factor x·l of each exit row and colour; x is [channel][row][coefficient].
void add_product(std::span<const float> x, int channel_count, const sh::Light& light, float factor,
                 std::span<Vec3> values) {
  for (std::size_t color = 0; color < 3; ++color) {
    const std::vector<float>& l = light.coefficients[color];
    const std::size_t first = channel_count == 3 ? color * values.size() * l.size() : 0;
    for (std::size_t row = 0; row < values.size(); ++row)
      values[row][static_cast<int>(color)] +=
          factor *
          std::inner_product(l.begin(), l.end(),
                             x.begin() + static_cast<std::ptrdiff_t>(first + row * l.size()), 0.0f);
  }
}

}  // namespace

std::vector<Vec3> exit_values(const gltf::PrecomputedTransfer& transfer, std::size_t vertex,
                              const sh::Light& light) {
  assert(light.band_count == transfer.band_count);
  const cpca::Encoding& encoding = transfer.encoding;
  const auto cluster = static_cast<int>(encoding.cluster_of_point[vertex]);
  const auto component_count = static_cast<std::size_t>(encoding.component_count);
  const float* const weights = encoding.weights.data() + vertex * component_count;
  std::vector<Vec3> values(static_cast<std::size_t>(transfer.row_count), Vec3(0.0f));
  add_product(encoding.mean(cluster), transfer.channel_count, light, 1.0f, values);
  for (int i = 0; i < encoding.component_count_of(cluster); ++i)
    add_product(encoding.basis(cluster, i), transfer.channel_count, light, weights[i], values);
  return values;
}

std::vector<Vec3> exit_values(const signal::TransferSignal& signal, std::size_t vertex,
                              const sh::Light& light) {
  assert(light.band_count == signal.band_count);
  const auto dimension = static_cast<std::size_t>(signal.dimension());
  std::vector<Vec3> values(static_cast<std::size_t>(signal.row_count), Vec3(0.0f));
  add_product(std::span(signal.values).subspan(vertex * dimension, dimension), signal.channel_count,
              light, 1.0f, values);
  return values;
}

Vec3 exit_radiance(std::span<const Vec3> exit_values, const Vec3& view) {
  if (exit_values.size() == 1) return exit_values[0];
  const std::vector<int> functions = sh::hemisphere_functions(static_cast<int>(exit_values.size()));
  const int band_count = sh::band_count_of(functions);
  std::vector<float> basis(static_cast<std::size_t>(sh::coefficient_count(band_count)));
  sh::evaluate(band_count, view.z > 0.0f ? view : Vec3(view.x, view.y, 0.0f).normalized(), basis);
  Vec3 radiance(0.0f);
  for (std::size_t row = 0; row < functions.size(); ++row)
    radiance += exit_values[row] * basis[static_cast<std::size_t>(functions[row])];
  return radiance;
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
