#include "signal/header_reader.h"

#include <ImfChannelList.h>
#include <ImfIntAttribute.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>
#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <limits>

#include "core/checked.h"
#include "core/error.h"
#include "core/exit_rows.h"

namespace prt::signal {

namespace {

/// Greatest number of pixel bytes that a stored byte can stand for; 0: not lossless.
std::size_t largest_expansion(Imf::Compression compression) {
  switch (compression) {
    case Imf::NO_COMPRESSION:
      return 1;
    case Imf::RLE_COMPRESSION:
      return 64;  // two bytes stand for a run of at most 128
    case Imf::ZIP_COMPRESSION:
    case Imf::ZIPS_COMPRESSION:
      return 1032;  // zlib: a match of 258 bytes takes at least two bits
    default:
      return 0;
  }
}

}  // namespace

void HeaderReader::reject(const std::string& element, const std::string& found,
                          const std::string& expected) const {
  throw_bad_input("not a transfer file of prtkit",
                  {.file = file_, .element = element, .found = found, .expected = expected});
}

template <class Attribute>
const auto& HeaderReader::attribute(const char* name) const {
  const Attribute* found = header_.findTypedAttribute<Attribute>(name);
  if (!found) {
    reject(fmt::format("attribute {}", name), "none of its type",
           fmt::format("a {}", Attribute::staticTypeName()));
  }
  return found->value();
}

int HeaderReader::int_attribute(const char* name, int lowest, int highest) const {
  const int value = attribute<Imf::IntAttribute>(name);
  if (value < lowest || value > highest) {
    reject(fmt::format("attribute {}", name), std::to_string(value),
           fmt::format("{} to {}", lowest, highest));
  }
  return value;
}

std::uint64_t HeaderReader::parse_count(const char* name, const std::string& text) const {
  std::uint64_t value = 0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc{} || result.ptr != end) {
    reject(fmt::format("attribute {}", name), fmt::format("\"{:.32}\"", text), "a decimal number");
  }
  return value;
}

void HeaderReader::read_blocks(TransferSignal& signal) const {
  const char* counts_name = "prtkit_block_vertex_counts";
  const auto& names = attribute<Imf::StringVectorAttribute>("prtkit_block_names");
  const auto& counts = attribute<Imf::StringVectorAttribute>(counts_name);
  if (names.empty() || names.size() != counts.size()) {
    reject("attributes prtkit_block_names and prtkit_block_vertex_counts",
           fmt::format("{} names and {} counts", names.size(), counts.size()),
           "as many of each, at least one");
  }
  std::size_t total = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::uint64_t count = parse_count(counts_name, counts[i]);
    if (count == 0) reject(fmt::format("attribute {}", counts_name), "0", "at least 1");
    if (__builtin_add_overflow(total, count, &total) || total > kMaxVertexCount) {
      reject(fmt::format("attribute {}", counts_name), "more",
             fmt::format("at most {} vertices", kMaxVertexCount));
    }
    signal.blocks.push_back({names[i], count});
  }
}

void HeaderReader::read_attributes(TransferSignal& signal) const {
  constexpr int kMaxInt = std::numeric_limits<int>::max();
  int_attribute("prtkit_version", kFormatVersion, kFormatVersion);
  signal.band_count = int_attribute("prtkit_band_count", 1, kMaxBandCount);
  signal.row_count = int_attribute("prtkit_row_count", 1, kMaxExitRowCount);
  if (!is_exit_row_count(signal.row_count)) {
    reject("attribute prtkit_row_count", std::to_string(signal.row_count), kExitRowCounts);
  }
  signal.channel_count = int_attribute("prtkit_channel_count", 1, 3);
  if (signal.channel_count == 2) reject("attribute prtkit_channel_count", "2", "1 or 3");
  // Within these ranges the product fits an int.
  if (signal.dimension() > kMaxDimension) {
    reject("dimension", std::to_string(signal.dimension()), fmt::format("to {}", kMaxDimension));
  }
  signal.ray_count = int_attribute("prtkit_ray_count", 0, kMaxInt);
  signal.bounce_count = int_attribute("prtkit_bounce_count", 0, kMaxInt);
  signal.seed = parse_count("prtkit_seed", attribute<Imf::StringAttribute>("prtkit_seed"));
  signal.brdf = attribute<Imf::StringAttribute>("prtkit_brdf");
  signal.tool_version = attribute<Imf::StringAttribute>("prtkit_tool_version");
  if (header_.find("prtkit_mesh_hash") != header_.end()) {  // other programs need not know how
    signal.mesh_hash = attribute<Imf::StringAttribute>("prtkit_mesh_hash");
  }
  read_blocks(signal);
}

// A lossy file would pass every other check and hold wrong numbers.
void HeaderReader::check_kind() const {
  if (header_.hasTileDescription() || (header_.hasType() && header_.type() != Imf::SCANLINEIMAGE)) {
    reject("image", "tiles or deep pixels", "scanlines");
  }
  if (largest_expansion(header_.compression()) == 0) {
    reject("compression", "one that is lossy, or not known to this reader", "none, RLE or ZIP");
  }
}

// As many channels as expected, and each expected one: so there are no others.
void HeaderReader::check_channels(const TransferSignal& signal) const {
  const Imf::ChannelList& channels = header_.channels();
  int channel_count = 0;
  for (auto i = channels.begin(); i != channels.end(); ++i) ++channel_count;
  if (channel_count != signal.dimension()) {
    reject("channels", std::to_string(channel_count), std::to_string(signal.dimension()));
  }
  for (int i = 0; i < signal.dimension(); ++i) {
    const std::string name = channel_name(signal, i);
    const Imf::Channel* channel = channels.findChannel(name);
    if (!channel || channel->type != Imf::FLOAT || channel->xSampling != 1 ||
        channel->ySampling != 1) {
      reject("channel " + name, channel ? "another pixel type or sampling" : "none",
             "a 32 bit float in each pixel");
    }
  }
}

void HeaderReader::check_window(const TransferSignal& signal) const {
  // The corners may be anywhere in the range of int: their difference need not fit one.
  const Imath::Box2i& window = header_.dataWindow();
  const auto width = std::int64_t{window.max.x} - window.min.x + 1;
  const auto height = std::int64_t{window.max.y} - window.min.y + 1;
  if (width < 1 || width > static_cast<std::int64_t>(kFileWidth)) {
    reject("data window", fmt::format("{} pixels wide", width), fmt::format("1 to {}", kFileWidth));
  }
  const std::size_t lines = line_count(signal.blocks, static_cast<std::size_t>(width));
  if (height < 1 || static_cast<std::size_t>(height) != lines) {
    reject("data window", fmt::format("{} scanlines", height),
           fmt::format("{}, from the vertex counts", lines));
  }
}

void HeaderReader::check_size(const TransferSignal& signal, std::size_t file_bytes,
                              std::size_t max_bytes) const {
  const std::size_t row_bytes = sizeof(float) * static_cast<std::size_t>(signal.dimension());
  const std::size_t value_bytes = checked_multiply(signal.vertex_count(), row_bytes);
  if (value_bytes > max_bytes) {
    throw_bad_input("transfer too large", {.file = file_,
                                           .found = fmt::format("{} bytes", value_bytes),
                                           .expected = fmt::format("at most {}", max_bytes),
                                           .advice = "Take fewer vertices, coefficients or "
                                                     "channels, or a machine of more memory."});
  }
  // Every line is stored whole, with the padding behind its block.
  const Imath::Box2i& window = header_.dataWindow();
  const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
  const std::size_t pixel_bytes =
      checked_multiply(line_count(signal.blocks, width), checked_multiply(width, row_bytes));
  const std::size_t least = pixel_bytes / largest_expansion(header_.compression());
  if (file_bytes < least) {
    throw_bad_input("truncated file", {.file = file_,
                                       .found = fmt::format("{} bytes", file_bytes),
                                       .expected = fmt::format("at least {}", least)});
  }
}

// In this order: each check relies on what those before it have bounded.
TransferSignal HeaderReader::read(std::size_t file_bytes, std::size_t max_bytes) const {
  TransferSignal signal;
  check_kind();
  read_attributes(signal);
  check_channels(signal);
  check_window(signal);
  check_size(signal, file_bytes, max_bytes);
  return signal;
}

}  // namespace prt::signal
