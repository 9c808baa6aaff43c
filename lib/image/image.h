// Float images, interleaved channels, first row on top; OpenImageIO behind it. Colour is linear
// Rec. 709: 8-bit files are decoded from sRGB on reading and encoded on writing.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace prt::image {

struct Image {
  int width = 0, height = 0, channel_count = 0;
  std::vector<float> pixels;  ///< width × height × channel_count

  Image() = default;
  Image(int w, int h, int channels)
      : width(w),
        height(h),
        channel_count(channels),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) *
               static_cast<std::size_t>(channels)) {}
  std::size_t pixel_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  float* at(int x, int y) { return pixels.data() + offset(x, y); }
  const float* at(int x, int y) const { return pixels.data() + offset(x, y); }

 private:
  std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
            static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(channel_count);
  }
};

/// Pixels allowed in an image that is read.
constexpr std::size_t kMaxPixels = std::size_t{1} << 28;

/// Reads .exr .hdr .png .jpg …: format by the magic bytes, never by the name. Non-finite values are
/// replaced by 0 and counted in a warning. Throws Error (bad_input).
Image read_image(const std::filesystem::path& path, std::size_t max_pixels = kMaxPixels);
/// What the numbers of 8-bit files are: colours, which are decoded, or others, taken as they are.
enum class Content { colour, data };

/// The same from memory; `name` is for messages. Only PNG and JPEG, the two formats of glTF.
Image read_image(std::span<const std::byte> bytes, const std::string& name,
                 std::size_t max_pixels = kMaxPixels, Content content = Content::colour);

/// Writes float EXR (ZIP) with channels R, G, B(, A), or 8-bit sRGB PNG, by the extension of
/// `path`; atomically. Throws Error.
void write_image(const std::filesystem::path& path, const Image& image, bool no_clobber = false);

}  // namespace prt::image
