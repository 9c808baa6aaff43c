#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <fstream>

#include "core/atomic_file.h"
#include "core/error.h"
#include "signal/layout.h"

namespace prt::signal {

namespace {

Imf::Header make_header(const TransferSignal& signal, int width, int height) {
  // Noise in the low bits of every float leaves little to compress: see docs/transfer-file.md.
  Imf::Header header(width, height, 1.0f, {0.0f, 0.0f}, 1.0f, Imf::INCREASING_Y,
                     Imf::NO_COMPRESSION);
  const auto add_int = [&](const char* name, int value) {
    header.insert(name, Imf::IntAttribute(value));
  };
  const auto add_string = [&](const char* name, const std::string& value) {
    header.insert(name, Imf::StringAttribute(value));
  };
  add_int("prtkit_version", kFormatVersion);
  add_int("prtkit_band_count", signal.band_count);
  add_int("prtkit_row_count", signal.row_count);
  add_int("prtkit_channel_count", signal.channel_count);
  add_int("prtkit_ray_count", signal.ray_count);
  add_int("prtkit_bounce_count", signal.bounce_count);
  add_string("prtkit_seed", std::to_string(signal.seed));
  add_string("prtkit_brdf", signal.brdf);
  add_string("prtkit_tool_version", signal.tool_version);
  if (!signal.mesh_hash.empty()) add_string("prtkit_mesh_hash", signal.mesh_hash);
  Imf::StringVector names, counts;
  for (const TransferSignal::Block& block : signal.blocks) {
    names.push_back(block.name);
    counts.push_back(std::to_string(block.vertex_count));
  }
  header.insert("prtkit_block_names", Imf::StringVectorAttribute(names));
  header.insert("prtkit_block_vertex_counts", Imf::StringVectorAttribute(counts));
  for (int i = 0; i < signal.dimension(); ++i) {
    header.channels().insert(channel_name(signal, i), Imf::Channel(Imf::FLOAT));
  }
  return header;
}

void write_image(const std::filesystem::path& path, const TransferSignal& signal,
                 const RowSource& rows) {
  std::size_t width = 0;
  for (const auto& block : signal.blocks) width = std::max(width, block.vertex_count);
  width = std::min(width, kFileWidth);
  const std::vector<Scanline> lines = scanlines(signal.blocks, width);
  const auto dimension = static_cast<std::size_t>(signal.dimension());
  std::vector<float> strip(kStripHeight * width * dimension), values;

  std::ofstream bytes(path, std::ios::binary);
  Imf::StdOFStream stream(bytes, path.c_str());
  {
    Imf::OutputFile file(
        stream, make_header(signal, static_cast<int>(width), static_cast<int>(lines.size())));
    for (std::size_t top = 0; top < lines.size(); top += kStripHeight) {
      const std::size_t bottom = std::min(lines.size(), top + kStripHeight);
      const std::size_t first = lines[top].first;
      const std::size_t end = lines[bottom - 1].first + lines[bottom - 1].count;
      values.resize((end - first) * dimension);
      rows(first, end - first, values);
      std::fill(strip.begin(), strip.end(), 0.0f);
      for (std::size_t line = top; line < bottom; ++line) {
        std::copy_n(&values[(lines[line].first - first) * dimension], lines[line].count * dimension,
                    &strip[(line - top) * width * dimension]);
      }
      file.setFrameBuffer(strip_frame_buffer(signal, strip, {0, static_cast<int>(top)}, width));
      file.writePixels(static_cast<int>(bottom - top));
    }
  }  // its destructor writes the table of line offsets and swallows errors
  bytes.close();
  if (!bytes) throw_failed("writing failed", {.file = path.string()});
}

}  // namespace

void write_transfer(const std::filesystem::path& path, const TransferSignal& signal,
                    bool no_clobber) {
  const auto dimension = static_cast<std::size_t>(signal.dimension());
  assert(signal.values.size() == signal.vertex_count() * dimension);
  const RowSource rows = [&](std::size_t first, std::size_t count, std::span<float> values) {
    std::copy_n(&signal.values[first * dimension], count * dimension, values.begin());
  };
  write_transfer(path, signal, rows, no_clobber);
}

void write_transfer(const std::filesystem::path& path, const TransferSignal& signal,
                    const RowSource& rows, bool no_clobber) {
  assert(signal.vertex_count() > 0);
  AtomicFile output(path, no_clobber);
  try {
    write_image(output.temporary_path(), signal, rows);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw_failed(fmt::format("writing failed ({})", error.what()), {.file = path.string()});
  }
  output.commit();
}

}  // namespace prt::signal
