#include "image/false_color.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace prt::image {

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

}  // namespace prt::image
