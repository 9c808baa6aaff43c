#include "image/image.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/atomic_file.h"
#include "core/checked.h"
#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "image/openimageio.h"
#include "image/prepare.h"
#include "image/srgb.h"

namespace prt::image {

namespace {

struct Format {
  const char* plugin;  ///< OpenImageIO's name
  const char* title;
  std::string_view magic;
  bool in_gltf;
};

using std::string_view_literals::operator""sv;
constexpr Format kFormats[] = {
    {"openexr", "OpenEXR", "\x76\x2f\x31\x01"sv, false},
    {"hdr", "Radiance HDR", "#?RADIANCE"sv, false},
    {"hdr", "Radiance HDR", "#?RGBE"sv, false},
    {"png", "PNG", "\x89PNG\r\n\x1a\n"sv, true},
    {"jpeg", "JPEG", "\xff\xd8\xff"sv, true},
};

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

const Format& format_of(std::span<const std::byte> bytes, const std::string& name, bool only_gltf) {
  for (const Format& format : kFormats) {
    if (text_of(bytes).starts_with(format.magic) && (format.in_gltf || !only_gltf)) return format;
  }
  throw_bad_input("not an image that prtkit reads",
                  {.file = name,
                   .found = bytes.empty() ? "an empty file" : "other bytes at its start",
                   .expected = only_gltf ? "PNG or JPEG" : "OpenEXR, Radiance HDR, PNG or JPEG"});
}

[[noreturn]] void throw_damaged(const Format& format, const std::string& name, std::string reason) {
  reason.resize(std::min(reason.size(), reason.find('\n')));  // the codec's first complaint
  throw_bad_input(fmt::format("damaged {} image", format.title),
                  {.file = name,
                   .found = reason.empty() ? "undecodable data" : reason,
                   .advice = "Is the file complete?"});
}

// libjpeg fills what a truncated file lacks with grey and only warns.
bool has_jpeg_end(std::string_view text) {
  const std::size_t scan = text.rfind("\xff\xda"sv), end = text.rfind("\xff\xd9"sv);
  return scan != std::string_view::npos && end != std::string_view::npos && end > scan;
}

// OpenImageIO loses memory when libpng reads past the end, so every chunk is seen to be there
// first: each has a big-endian length, a type, its data and a checksum.
bool has_png_end(std::string_view text) {
  for (std::size_t at = 8; at + 12 <= text.size();) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      length = length << 8 | static_cast<unsigned char>(text[at + i]);
    }
    if (length > text.size() - at - 12) return false;
    if (text.substr(at + 4, 4) == "IEND"sv) return true;
    at += 12 + length;
  }
  return false;
}

void check_size(const FileLayout& layout, const std::string& name, std::size_t max_pixels) {
  if (layout.is_deep || layout.channel_count < 1 || layout.depth > 1) {
    throw_bad_input("not a flat image", {.file = name});
  }
  const auto width = static_cast<std::size_t>(std::max(layout.width, 0));
  const auto height = static_cast<std::size_t>(std::max(layout.height, 0));
  if (width == 0 || height == 0 || checked_multiply(width, height) > max_pixels) {
    throw_bad_input("image size out of range",
                    {.file = name,
                     .found = fmt::format("{} x {} pixels", layout.width, layout.height),
                     .expected = fmt::format("1 to {} pixels", max_pixels)});
  }
}

/// Greatest number of pixel bytes that a stored byte can stand for; none where that is not known.
std::optional<std::size_t> largest_expansion(const Format& format, const FileLayout& layout) {
  constexpr std::size_t kRunLength = 64, kDeflate = 1032;
  if (format.plugin == "png"sv) return kDeflate;
  if (format.plugin == "hdr"sv) return kRunLength;
  if (layout.compression == "none") return 1;
  if (layout.compression == "rle") return kRunLength;
  if (layout.compression == "zip" || layout.compression == "zips") return kDeflate;
  return std::nullopt;
}

/// In the file, before compression.
std::size_t bits_per_pixel(const Format& format, const FileLayout& layout,
                           std::span<const std::byte> bytes) {
  if (format.plugin == "hdr"sv) return 4 * 8;
  if (format.plugin != "png"sv) return 8 * layout.pixel_bytes;
  const auto depth = static_cast<std::size_t>(bytes[24]),
             type = static_cast<std::size_t>(bytes[25]);
  const bool has_palette = type & 1, has_color = type & 2, has_alpha = type & 4;
  return depth * ((has_color && !has_palette ? 3 : 1) + has_alpha);
}

/// A small file must not make us take the memory of a huge image before its data turn out missing.
void check_file_size(const Format& format, const FileLayout& layout, const std::string& name,
                     std::span<const std::byte> bytes) {
  const std::optional<std::size_t> expansion = largest_expansion(format, layout);
  const std::size_t pixels =
      static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(layout.height);
  const std::size_t pixel_bytes =
      checked_multiply(pixels, bits_per_pixel(format, layout, bytes)) / 8;
  if (expansion && pixel_bytes / *expansion > bytes.size()) {
    throw_damaged(
        format, name,
        fmt::format("{} bytes for {} x {} pixels", bytes.size(), layout.width, layout.height));
  }
}

void decode_srgb(Image& image) {
  const int colour_count = image.channel_count > 2 ? 3 : 1;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    if (static_cast<int>(i % static_cast<std::size_t>(image.channel_count)) < colour_count) {
      image.pixels[i] = linear_from_srgb(image.pixels[i]);
    }
  }
}

void replace_non_finite(Image& image, const std::string& name) {
  std::size_t count = 0;
  for (float& value : image.pixels) {
    if (std::isfinite(value)) continue;
    value = 0;
    ++count;
  }
  if (count > 0) log::warning("{}: {} values that are not finite replaced by 0", name, count);
}

Image decode(const Format& format, std::span<const std::byte> bytes, const std::string& name,
             std::size_t max_pixels, Content content) {
  const auto check = [&](const FileLayout& layout) {
    check_size(layout, name, max_pixels);
    check_file_size(format, layout, name, bytes);
  };
  Image image = open_image_io().decode(format.plugin, bytes, name, check);
  if (format.in_gltf && content == Content::colour) decode_srgb(image);
  replace_non_finite(image, name);
  return image;
}

Image decode_checked(std::span<const std::byte> bytes, const std::string& name,
                     std::size_t max_pixels, bool only_gltf, Content content) {
  const Format& format = format_of(bytes, name, only_gltf);
  const std::string_view text = text_of(bytes);
  if ((format.plugin == "jpeg"sv && !has_jpeg_end(text)) ||
      (format.plugin == "png"sv && !has_png_end(text))) {
    throw_damaged(format, name, "no end of image");
  }
  try {
    return decode(format, bytes, name, max_pixels, content);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw_damaged(format, name, error.what());
  }
}

std::vector<unsigned char> encode(const Image& image, const std::string& name, bool is_png) {
  const OpenImageIo& calls = open_image_io();
  try {
    return calls.encode(image, is_png ? srgb8_from_linear(image) : std::vector<std::uint8_t>{},
                        name);
  } catch (const std::runtime_error& error) {
    throw_failed("encoding the image failed", {.file = name, .found = error.what()});
  }
}

}  // namespace

Image read_image(const std::filesystem::path& path, std::size_t max_pixels) {
  return decode_checked(read_file(path), path.string(), max_pixels, false, Content::colour);
}

Image read_image(std::span<const std::byte> bytes, const std::string& name, std::size_t max_pixels,
                 Content content) {
  return decode_checked(bytes, name, max_pixels, true, content);
}

std::unique_ptr<AtomicFile> prepare_image(const std::filesystem::path& path, const Image& image,
                                          bool no_clobber) {
  const std::string extension = lower_extension(path);
  if (extension != ".exr" && extension != ".png") {
    throw Error(ErrorKind::usage, "unknown kind of image",
                {.file = path.string(), .found = extension, .expected = ".exr or .png"});
  }
  auto file = std::make_unique<AtomicFile>(path, no_clobber);
  const std::vector<unsigned char> bytes = encode(image, path.string(), extension == ".png");
  file->write(std::as_bytes(std::span(bytes)));
  return file;
}

void write_image(const std::filesystem::path& path, const Image& image, bool no_clobber) {
  prepare_image(path, image, no_clobber)->commit();
}

}  // namespace prt::image
