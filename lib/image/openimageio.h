// OpenImageIO, in a library of its own that is loaded when the first image is read or written: 240
// others come with it and take a third of a second, which tools that meet no image do not spend.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "image/image.h"

namespace prt::image {

/// What an image file says of its pixels.
struct FileLayout {
  int width = 0, height = 0, depth = 0, channel_count = 0;
  bool is_deep = false;
  std::size_t pixel_bytes = 0;  ///< before compression
  std::string compression;
};

constexpr int kMaxChannels = 4;

struct OpenImageIo {
  const char* version;  ///< of prtkit: of another this may look otherwise
  /// The first kMaxChannels channels of a file whose format OpenImageIO calls `format`, as stored.
  /// `check` throws if it does not want pixels of that layout. What is wrong with the file is
  /// thrown as std::runtime_error. `name` is for messages.
  Image (*decode)(const char* format, std::span<const std::byte> file, const std::string& name,
                  const std::function<void(const FileLayout&)>& check);
  /// The bytes of a PNG of the sRGB values, or, where there are none, of an EXR of the image's.
  /// What went wrong is thrown as std::runtime_error.
  std::vector<unsigned char> (*encode)(const Image& image, std::span<const std::uint8_t> srgb,
                                       const std::string& name);
};

/// Loads it the first time. Throws Error.
const OpenImageIo& open_image_io();

}  // namespace prt::image
