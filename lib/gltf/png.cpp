#include "gltf/png.h"

#include "core/error.h"
#include "image/srgb.h"

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace prt::gltf {

namespace {

void append(void* context, void* data, int size) {
  auto& bytes = *static_cast<std::vector<std::byte>*>(context);
  const auto* begin = static_cast<const std::byte*>(data);
  bytes.insert(bytes.end(), begin, begin + size);
}

}  // namespace

std::vector<std::byte> encode_png(const image::Image& image) {
  const int channels = image.channel_count;
  const std::vector<std::uint8_t> pixels = image::srgb8_from_linear(image);
  std::vector<std::byte> bytes;
  if (!stbi_write_png_to_func(append, &bytes, image.width, image.height, channels, pixels.data(),
                              image.width * channels)) {
    throw_failed("cannot encode a texture as PNG");
  }
  return bytes;
}

}  // namespace prt::gltf
