// The library that lib/image loads: all calls of OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "image/openimageio.h"

namespace {

using namespace prt::image;

Image decode(const char* format, std::span<const std::byte> file, const std::string& name,
             const std::function<void(const FileLayout&)>& check) {
  OIIO::Filesystem::IOMemReader reader(const_cast<std::byte*>(file.data()), file.size());
  const auto input = OIIO::ImageInput::create(format);
  if (!input) throw std::runtime_error(std::string("OpenImageIO lacks ") + format);
  OIIO::ImageSpec config, spec;
  config.attribute("oiio:UnassociatedAlpha", 1);
  input->set_ioproxy(&reader);
  if (!input->open(name, spec, config)) throw std::runtime_error(input->geterror());
  check({.width = spec.width,
         .height = spec.height,
         .depth = spec.depth,
         .channel_count = spec.nchannels,
         .is_deep = spec.deep,
         .pixel_bytes = spec.pixel_bytes(true),
         .compression = spec.get_string_attribute("compression")});
  Image image(spec.width, spec.height, std::min(spec.nchannels, kMaxChannels));
  const bool complete =
      input->read_image(0, 0, 0, image.channel_count, OIIO::TypeDesc::FLOAT, image.pixels.data());
  const std::string error = input->geterror();
  if (!complete || !error.empty()) throw std::runtime_error(error);
  return image;
}

std::vector<unsigned char> encode(const Image& image, std::span<const std::uint8_t> srgb,
                                  const std::string& name) {
  const bool is_png = !srgb.empty();
  OIIO::ImageSpec spec(image.width, image.height, image.channel_count,
                       is_png ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT);
  if (is_png) {
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("oiio:UnassociatedAlpha", 1);
  } else {
    spec.attribute("compression", "zip");
    spec.attribute("DateTime", "1970:01:01 00:00:00");  // else the time of day
  }
  const auto output = OIIO::ImageOutput::create(is_png ? "png" : "openexr");
  if (!output) throw std::runtime_error("no encoder");
  std::vector<unsigned char> file;
  OIIO::Filesystem::IOVecOutput proxy(file);
  const void* data = is_png ? static_cast<const void*>(srgb.data()) : image.pixels.data();
  if (!output->set_ioproxy(&proxy) || !output->open(name, spec) ||
      !output->write_image(spec.format, data) || !output->close()) {
    throw std::runtime_error(output->geterror());
  }
  return file;
}

}  // namespace

extern "C" const OpenImageIo prtkit_openimageio{PRTKIT_VERSION, decode, encode};
