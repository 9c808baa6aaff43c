#include "image/srgb.h"

#include <algorithm>
#include <cmath>

namespace prt::image {

float linear_from_srgb(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

float srgb_from_linear(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

std::vector<std::uint8_t> srgb8_from_linear(const Image& image) {
  const auto channel_count = static_cast<std::size_t>(image.channel_count);
  const std::size_t colour_count = channel_count > 2 ? 3 : 1;
  std::vector<std::uint8_t> bytes(image.pixels.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const float value = std::clamp(image.pixels[i], 0.0f, 1.0f);
    const float encoded = i % channel_count < colour_count ? srgb_from_linear(value) : value;
    bytes[i] = static_cast<std::uint8_t>(std::lround(255 * encoded));
  }
  return bytes;
}

}  // namespace prt::image
