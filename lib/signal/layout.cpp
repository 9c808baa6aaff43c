#include "signal/layout.h"

#include <fmt/format.h>

#include <algorithm>

namespace prt::signal {

std::size_t TransferSignal::vertex_count() const {
  std::size_t count = 0;
  for (const Block& block : blocks) count += block.vertex_count;
  return count;
}

std::string channel_name(const TransferSignal& signal, int index) {
  const int source_count = signal.band_count * signal.band_count;
  const int source = index % source_count;
  const int row = index / source_count % signal.row_count;
  const int channel = index / (source_count * signal.row_count);
  return fmt::format("exit{:03}.source{:03}.{}", row, source,
                     signal.channel_count == 1 ? 'Y' : "RGB"[channel]);
}

std::size_t line_count(std::span<const TransferSignal::Block> blocks, std::size_t width) {
  std::size_t count = 0;
  for (const TransferSignal::Block& block : blocks) {
    count += (block.vertex_count + width - 1) / width;
  }
  return count;
}

std::vector<Scanline> scanlines(std::span<const TransferSignal::Block> blocks, std::size_t width) {
  std::vector<Scanline> lines;
  std::size_t first = 0;
  for (const TransferSignal::Block& block : blocks) {
    for (std::size_t done = 0; done < block.vertex_count; done += width) {
      lines.push_back({first + done, std::min(width, block.vertex_count - done)});
    }
    first += block.vertex_count;
  }
  return lines;
}

Imf::FrameBuffer strip_frame_buffer(const TransferSignal& signal, std::span<float> strip,
                                    Imath::V2i corner, std::size_t width) {
  const auto dimension = static_cast<std::size_t>(signal.dimension());
  const std::size_t height = strip.size() / (width * dimension);
  Imf::FrameBuffer pixels;
  for (std::size_t i = 0; i < dimension; ++i) {
    pixels.insert(channel_name(signal, static_cast<int>(i)),
                  Imf::Slice::Make(Imf::FLOAT, &strip[i], corner, static_cast<int64_t>(width),
                                   static_cast<int64_t>(height), dimension * sizeof(float),
                                   width * dimension * sizeof(float)));
  }
  return pixels;
}

}  // namespace prt::signal
