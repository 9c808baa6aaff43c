#include "gltf/png.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace prt::gltf {

namespace {

unsigned char quantize(float value) {
  return static_cast<unsigned char>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
}

float srgb_from_linear(float value) {
  return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
}

void append(void* context, void* data, int size) {
  auto& bytes = *static_cast<std::vector<std::byte>*>(context);
  const auto* begin = static_cast<const std::byte*>(data);
  bytes.insert(bytes.end(), begin, begin + size);
}

}  // namespace

std::vector<std::byte> encode_png(const image::Image& image) {
  const int channels = image.channel_count;
  std::vector<unsigned char> pixels(image.pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const int channel = static_cast<int>(i % static_cast<std::size_t>(channels));
    const bool alpha = channels % 2 == 0 && channel == channels - 1;
    pixels[i] = quantize(alpha ? image.pixels[i] : srgb_from_linear(image.pixels[i]));
  }
  std::vector<std::byte> bytes;
  if (!stbi_write_png_to_func(append, &bytes, image.width, image.height, channels, pixels.data(),
                              image.width * channels)) {
    throw_failed("cannot encode a texture as PNG");
  }
  return bytes;
}

}  // namespace prt::gltf
