// How a transfer signal lies in the OpenEXR image (docs/transfer-file.md): what the writer and the
// reader share.
#pragma once

#include <ImfFrameBuffer.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "signal/transfer_signal.h"

namespace prt::signal {

constexpr int kFormatVersion = 1;

/// Pixels in a scanline of the files that we write (fewer when no block has as many vertices), and
/// the most that is read: it bounds the memory that a strip takes.
constexpr std::size_t kFileWidth = 256;

/// What a file may not exceed; bands as sh::kMaxBandCount has it.
constexpr int kMaxBandCount = 16;
constexpr std::size_t kMaxVertexCount = std::size_t{1} << 31;

/// Scanlines that go through memory together.
constexpr std::size_t kStripHeight = 16;

/// Name of the EXR channel that holds coefficient `index` of a row of the signal:
/// exit000.source024.R, or .Y where there is one colour channel.
std::string channel_name(const TransferSignal& signal, int index);

/// The vertices of one scanline: `count` of them from `first`; the rest of the line is padding.
struct Scanline {
  std::size_t first;
  std::size_t count;
};

/// Scanlines of an image `width` pixels wide; every block starts a new one.
std::size_t line_count(std::span<const TransferSignal::Block> blocks, std::size_t width);
std::vector<Scanline> scanlines(std::span<const TransferSignal::Block> blocks, std::size_t width);

/// OpenEXR's view of a strip of scanlines, `width` pixels of `dimension()` floats each, whose upper
/// left pixel is `corner` of the image.
Imf::FrameBuffer strip_frame_buffer(const TransferSignal& signal, std::span<float> strip,
                                    Imath::V2i corner, std::size_t width);

}  // namespace prt::signal
