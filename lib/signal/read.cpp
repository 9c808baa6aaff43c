#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "core/error.h"
#include "signal/header_reader.h"
#include "signal/prescan.h"

namespace prt::signal {

namespace {

void check_finite(const TransferSignal& signal, const std::string& file) {
  const auto bad = std::find_if(signal.values.begin(), signal.values.end(),
                                [](float value) { return !std::isfinite(value); });
  if (bad == signal.values.end()) return;
  const auto dimension = static_cast<std::size_t>(signal.dimension());
  const auto index = static_cast<std::size_t>(bad - signal.values.begin());
  std::size_t vertex = index / dimension, block = 0;
  while (vertex >= signal.blocks[block].vertex_count) vertex -= signal.blocks[block++].vertex_count;
  throw_bad_input(
      "the transfer is not finite",
      {.file = file,
       .element = fmt::format("primitive {} ({}), vertex {}, {}", block, signal.blocks[block].name,
                              vertex, channel_name(signal, static_cast<int>(index % dimension))),
       .found = fmt::format("{}", *bad),
       .expected = "a number",
       .advice = "Run prt-transfer again."});
}

void read_pixels(Imf::InputPart& part, TransferSignal& signal) {
  const Imath::Box2i window = part.header().dataWindow();
  const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
  const auto dimension = static_cast<std::size_t>(signal.dimension());
  const std::vector<Scanline> lines = scanlines(signal.blocks, width);
  signal.values.resize(signal.vertex_count() * dimension);
  std::vector<float> strip(std::min(kStripHeight, lines.size()) * width * dimension);
  for (std::size_t top = 0; top < lines.size(); top += kStripHeight) {
    const std::size_t bottom = std::min(lines.size(), top + kStripHeight);
    const int y = window.min.y + static_cast<int>(top);
    part.setFrameBuffer(strip_frame_buffer(signal, strip, {window.min.x, y}, width));
    part.readPixels(y, y + static_cast<int>(bottom - top) - 1);
    for (std::size_t line = top; line < bottom; ++line) {
      std::copy_n(&strip[(line - top) * width * dimension], lines[line].count * dimension,
                  &signal.values[lines[line].first * dimension]);
    }
  }
}

TransferSignal read_image(const std::filesystem::path& path, std::size_t max_bytes) {
  const std::string name = path.string();
  prescan_header(path);
  Imf::MultiPartInputFile file(name.c_str());
  if (file.parts() != 1) {
    throw_bad_input(
        "not a transfer file of prtkit",
        {.file = name, .found = fmt::format("{} parts", file.parts()), .expected = "one"});
  }
  TransferSignal signal =
      HeaderReader(file.header(0), name).read(std::filesystem::file_size(path), max_bytes);
  if (!file.partComplete(0)) throw_bad_input("truncated file", {.file = name});
  Imf::InputPart part(file, 0);
  read_pixels(part, signal);
  check_finite(signal, name);
  return signal;
}

}  // namespace

TransferSignal read_transfer(const std::filesystem::path& path, std::size_t max_bytes) {
  if (!std::filesystem::is_regular_file(path)) {
    throw_bad_input(std::filesystem::exists(path) ? "not a regular file" : "no such file",
                    {.file = path.string()});
  }
  try {
    return read_image(path, max_bytes);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw_bad_input(fmt::format("not a readable OpenEXR file ({})", error.what()),
                    {.file = path.string()});
  }
}

}  // namespace prt::signal
