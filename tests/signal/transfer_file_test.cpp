// The transfer file: round trips and bytes.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "signal/transfer_files.h"

namespace prt::signal {
namespace {

TEST_F(TransferFile, RoundTripsBitForBit) {
  for (const auto& counts : {std::vector<std::size_t>{1}, {256}, {257, 3, 1000}, {5000}}) {
    TransferSignal signal = make_signal(3, 3, 3, counts);
    signal.values.front() = -0.0f;
    signal.values.back() = std::numeric_limits<float>::denorm_min();
    write_transfer(path(), signal);
    const TransferSignal read = read_transfer(path());
    EXPECT_EQ(read.band_count, 3);
    EXPECT_EQ(read.row_count, 3);
    EXPECT_EQ(read.channel_count, 3);
    EXPECT_EQ(read.brdf, "lambert");
    EXPECT_EQ(read.seed, signal.seed);
    EXPECT_EQ(read.ray_count, 2048);
    EXPECT_EQ(read.bounce_count, 2);
    EXPECT_EQ(read.tool_version, "0.1.0");
    EXPECT_EQ(read.mesh_hash, signal.mesh_hash);
    ASSERT_EQ(read.blocks.size(), counts.size());
    for (std::size_t i = 0; i < counts.size(); ++i) {
      EXPECT_EQ(read.blocks[i].name, signal.blocks[i].name);
      EXPECT_EQ(read.blocks[i].vertex_count, counts[i]);
    }
    ASSERT_EQ(read.values.size(), signal.values.size());
    EXPECT_EQ(std::memcmp(read.values.data(), signal.values.data(), 4 * read.values.size()), 0);
  }
}

TEST_F(TransferFile, SameSignalGivesSameBytes) {
  const TransferSignal signal = make_signal(5, 1, 1, {700, 20});
  write_transfer(path("a.exr"), signal);
  write_transfer(path("b.exr"), signal);
  EXPECT_EQ(read_file(path("a.exr")), read_file(path("b.exr")));
}

TEST_F(TransferFile, RowsThatComeAsTheyAreAskedForGiveTheSameBytes) {
  TransferSignal signal = make_signal(2, 4, 3, {5000, 3, 256, 700});
  write_transfer(path("a.exr"), signal);
  const std::vector<float> all = std::move(signal.values);
  signal.values.clear();
  const auto dimension = static_cast<std::size_t>(signal.dimension());
  std::size_t next = 0, most = 0;
  const RowSource rows = [&](std::size_t first, std::size_t count, std::span<float> values) {
    EXPECT_EQ(first, next);
    EXPECT_EQ(values.size(), count * dimension);
    std::copy_n(&all[first * dimension], values.size(), values.begin());
    next += count;
    most = std::max(most, count);
  };
  write_transfer(path("b.exr"), signal, rows);
  EXPECT_EQ(next, 5959u);
  EXPECT_LE(most, 4096u);
  EXPECT_EQ(read_file(path("a.exr")), read_file(path("b.exr")));
}

// Read with nothing but OpenEXR, as docs/transfer-file.md describes it.
TEST_F(TransferFile, LiesAsDocumented) {
  const TransferSignal signal = make_signal(2, 1, 3, {300, 10});
  write_transfer(path(), signal);
  Imf::InputFile file(path().c_str());
  const Imath::Box2i window = file.header().dataWindow();
  ASSERT_EQ(window.max, Imath::V2i(255, 2));
  std::vector<float> pixels(3 * 256);
  Imf::FrameBuffer frame;
  frame.insert("exit000.source003.B",
               Imf::Slice::Make(Imf::FLOAT, pixels.data(), window, 4, 256 * 4));
  file.setFrameBuffer(frame);
  file.readPixels(0, 2);
  const auto expected = [&](std::size_t vertex) { return signal.values[vertex * 12 + 11]; };
  EXPECT_EQ(pixels[0], expected(0));
  EXPECT_EQ(pixels[255], expected(255));
  EXPECT_EQ(pixels[256 + 43], expected(299));
  EXPECT_EQ(pixels[256 + 44], 0.0f);
  EXPECT_EQ(pixels[512 + 9], expected(309));
}

TEST_F(TransferFile, NamesTheVertexThatIsNotFinite) {
  TransferSignal signal = make_signal(2, 1, 1, {300, 10});
  signal.values[(300 + 7) * 4 + 2] = std::nanf("");
  write_transfer(path(), signal);
  expect_contains(reading_error(path()), "primitive 1 (part 1), vertex 7, exit000.source002.Y");
}

TEST_F(TransferFile, LeavesNothingWhenWritingFails) {
  const TransferSignal signal = make_signal(2, 1, 1, {600});
  EXPECT_THROW(write_transfer(folder_ / "no" / "such" / "folder.exr", signal), Error);
  write_transfer(path(), signal);
  const std::vector<std::byte> before = read_file(path());
  EXPECT_THROW(write_transfer(path(), make_signal(2, 1, 1, {10}), true), Error);
  EXPECT_EQ(read_file(path()), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace prt::signal
