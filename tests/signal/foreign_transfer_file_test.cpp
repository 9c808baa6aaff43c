// Transfer files that something else wrote, or that are damaged.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <functional>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "signal/transfer_files.h"

namespace prt::signal {
namespace {

class ForeignTransferFile : public TransferFile {};

/// Header::erase of OpenEXR 3.1 does not free what it takes out.
void remove(Imf::Header& header, const std::string& name) {
  Imf::Header rest;
  for (auto i = header.begin(); i != header.end(); ++i)
    if (i.name() != name) rest.insert(i.name(), i.attribute());
  header = rest;
}

/// An image of 4 × 1 pixels that says it holds a transfer of 4 vertices and 1 band, after `change`.
void write_stranger(const fs::path& path, const std::function<void(Imf::Header&)>& change) {
  Imf::Header header(4, 1);
  header.compression() = Imf::NO_COMPRESSION;
  header.insert("prtkit_version", Imf::IntAttribute(1));
  header.insert("prtkit_band_count", Imf::IntAttribute(1));
  header.insert("prtkit_row_count", Imf::IntAttribute(1));
  header.insert("prtkit_channel_count", Imf::IntAttribute(1));
  header.insert("prtkit_ray_count", Imf::IntAttribute(16));
  header.insert("prtkit_bounce_count", Imf::IntAttribute(0));
  for (const char* name : {"seed", "brdf", "tool_version", "mesh_hash"}) {
    header.insert(std::string("prtkit_") + name, Imf::StringAttribute("1"));
  }
  header.insert("prtkit_block_names", Imf::StringVectorAttribute({"a"}));
  header.insert("prtkit_block_vertex_counts", Imf::StringVectorAttribute({"4"}));
  header.channels().insert("exit000.source000.Y", Imf::Channel(Imf::FLOAT));
  change(header);
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(Imf::FrameBuffer());  // zeros
  file.writePixels(header.dataWindow().max.y - header.dataWindow().min.y + 1);
}

TEST_F(ForeignTransferFile, RefusesWhatIsNoTransferFile) {
  expect_contains(reading_error(path("missing.exr")), "no such file");
  expect_contains(reading_error(folder_), "not a regular file");
  std::ofstream(path("text.exr")) << "not an image at all";
  expect_contains(reading_error(path("text.exr")), "not a readable OpenEXR file");
  std::ofstream(path("empty.exr")).close();
  expect_contains(reading_error(path("empty.exr")), "not a readable OpenEXR file");
}

TEST_F(ForeignTransferFile, RefusesAFileCutAnywhere) {
  write_transfer(path(), make_signal(2, 1, 1, {600}));
  const std::vector<std::byte> bytes = read_file(path());
  for (std::size_t length = 0; length < bytes.size(); length += 97) {
    std::ofstream(path("cut.exr"), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(length));
    EXPECT_THROW(read_transfer(path("cut.exr")), Error) << length << " bytes";
  }
}

TEST_F(ForeignTransferFile, AsksBeforeTakingTooMuchMemory) {
  write_transfer(path(), make_signal(2, 1, 1, {600}));
  EXPECT_NO_THROW(read_transfer(path(), 600 * 4 * 4));
  EXPECT_THROW(read_transfer(path(), 600 * 4 * 4 - 1), Error);
}

TEST_F(ForeignTransferFile, RefusesHeadersThatClaimMoreThanTheFileHolds) {
  write_stranger(path(), [](Imf::Header&) {});
  const std::string whole = read_text_file(path());
  const auto patch = [&](const std::string& attribute, std::size_t offset) {
    std::string bytes = whole;
    const std::int32_t huge = 0x40000000;
    std::memcpy(&bytes[bytes.find(attribute) + attribute.size() + offset], &huge, sizeof(huge));
    std::ofstream(path("claims.exr"), std::ios::binary) << bytes;
    expect_contains(reading_error(path("claims.exr")), "claims more than the file holds");
  };
  using namespace std::string_literals;
  patch("prtkit_brdf\0string\0"s, 0);
  patch("dataWindow\0box2i\0"s, 4 + 12);  // the last scanline
}

TEST_F(ForeignTransferFile, RefusesWindowsWiderThanTheStoredLines) {
  write_transfer(path(), make_signal(2, 1, 1, {100}));
  const std::string whole = read_text_file(path());
  const auto error_at_width = [&](std::int32_t width) {
    using namespace std::string_literals;
    const std::string attribute = "dataWindow\0box2i\0"s;
    const std::int32_t last = width - 1;
    std::string bytes = whole;
    std::memcpy(&bytes[bytes.find(attribute) + attribute.size() + 4 + 8], &last, sizeof(last));
    std::ofstream(path("wide.exr"), std::ios::binary) << bytes;
    return reading_error(path("wide.exr"));
  };
  expect_contains(error_at_width(256), "truncated file");  // 256 × 4 floats are not there
  expect_contains(error_at_width(65536), "65536 pixels wide");
}

TEST_F(ForeignTransferFile, ReadsWhatAnotherProgramWrote) {
  for (Imf::Compression compression :
       {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION}) {
    write_stranger(path(), [&](Imf::Header& header) { header.compression() = compression; });
    EXPECT_EQ(read_transfer(path()).vertex_count(), 4u);
  }
  // Any width, any corner: two vertices a line.
  write_stranger(path(), [](Imf::Header& header) { header.dataWindow() = {{-7, 3}, {-6, 4}}; });
  EXPECT_EQ(read_transfer(path()).vertex_count(), 4u);
}

TEST_F(ForeignTransferFile, BelongsWhereCountsFitUnlessAHashThatCanBeComparedSaysNo) {
  mesh::Scene scene;
  mesh::Primitive& primitive = scene.primitives.emplace_back();
  primitive.mesh.positions.assign(4, Vec3(0.0f));
  primitive.mesh.normals.assign(4, Vec3(0.0f, 0.0f, 1.0f));
  const auto said_with_hash = [&](const char* hash) {
    write_stranger(path(), [&](Imf::Header& header) {
      remove(header, "prtkit_mesh_hash");
      if (hash) header.insert("prtkit_mesh_hash", Imf::StringAttribute(hash));
    });
    testing::internal::CaptureStderr();
    std::string error;
    try {
      check_belongs_to(read_transfer(path()), scene, path());
    } catch (const Error& caught) {
      error = caught.what();
    }
    return error + testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(said_with_hash(nullptr), "");
  EXPECT_EQ(said_with_hash(mesh::mesh_hash(scene).c_str()), "");
  expect_contains(said_with_hash("3df243d100d3cbc776a45bc90316d2fe"), "another version of prtkit");
  expect_contains(said_with_hash("2:00000000000000000000000000000000"), "belongs to another mesh");
  primitive.mesh.positions.emplace_back(0.0f);
  expect_contains(said_with_hash(nullptr), "belongs to another mesh");
}

TEST_F(ForeignTransferFile, KeepsToHavingNoHash) {
  TransferSignal signal = make_signal(1, 1, 1, {4});
  signal.mesh_hash.clear();
  write_transfer(path(), signal);
  EXPECT_EQ(read_transfer(path()).mesh_hash, "");
  EXPECT_EQ(read_text_file(path()).find("prtkit_mesh_hash"), std::string::npos);
}

TEST_F(ForeignTransferFile, RefusesHeadersThatDoNotFit) {
  using Header = Imf::Header;
  const auto set_int = [](const char* name, int value) {
    return [=](Header& header) { header.insert(name, Imf::IntAttribute(value)); };
  };
  const auto set_counts = [](std::vector<std::string> counts) {
    return [=](Header& header) {
      header.insert("prtkit_block_vertex_counts", Imf::StringVectorAttribute(counts));
    };
  };
  const struct {
    std::function<void(Header&)> change;
    const char* message;
  } cases[] = {
      {[](Header& header) { remove(header, "prtkit_band_count"); }, "prtkit_band_count"},
      {[](Header& header) {
         remove(header, "prtkit_ray_count");
         header.insert("prtkit_ray_count", Imf::StringAttribute("16"));
       },
       "prtkit_ray_count"},
      {set_int("prtkit_version", 2), "found 2, expected 1 to 1"},
      {set_int("prtkit_band_count", 0), "prtkit_band_count"},
      {set_int("prtkit_band_count", 1 << 20), "prtkit_band_count"},
      {set_int("prtkit_band_count", 17), "found 17, expected 1 to 16"},  // sh has no more
      {set_int("prtkit_band_count", 2),
       "channels: not a transfer file of prtkit: found 1, expected 4"},
      {set_int("prtkit_row_count", -1), "prtkit_row_count"},
      {set_int("prtkit_row_count", 257), "found 257, expected 1 to 256"},
      {set_int("prtkit_row_count", 2), "found 2, expected 1, or n² or n² - 1"},
      {set_int("prtkit_row_count", 5), "found 5, expected 1, or n² or n² - 1"},
      {set_int("prtkit_row_count", 14), "found 14, expected 1, or n² or n² - 1"},
      {set_int("prtkit_row_count", 15),
       "channels: not a transfer file of prtkit: found 1, expected 15"},
      {set_int("prtkit_channel_count", 2), "prtkit_channel_count"},
      {set_int("prtkit_bounce_count", -1), "prtkit_bounce_count"},
      {[](Header& header) { header.insert("prtkit_seed", Imf::StringAttribute("-1")); },
       "prtkit_seed"},
      {set_counts({}), "1 names and 0 counts"},
      {set_counts({"2", "2"}), "1 names and 2 counts"},
      {set_counts({""}), "a decimal number"},
      {set_counts({"4x"}), "a decimal number"},
      {set_counts({"99999999999999999999"}), "a decimal number"},
      {set_counts({"18446744073709551615"}), "at most 2147483648 vertices"},
      {set_counts({"0"}), "at least 1"},
      {set_counts({"5"}), "1 scanlines, expected 2"},
      {[](Header& header) { header.dataWindow().max.y = 1; }, "2 scanlines, expected 1"},
      {[](Header& header) { header.dataWindow().max.x = 100000; }, "100001 pixels wide"},
      {[](Header& header) { header.channels().insert("Z", Imf::Channel(Imf::FLOAT)); },
       "found 2, expected 1"},
      {[](Header& header) {
         header.channels() = Imf::ChannelList();
         header.channels().insert("exit000.source000.R", Imf::Channel(Imf::FLOAT));
       },
       "channel exit000.source000.Y"},
      {[](Header& header) {
         header.channels().insert("exit000.source000.Y", Imf::Channel(Imf::HALF));
       },
       "another pixel type"},
      {[](Header& header) { header.compression() = Imf::B44_COMPRESSION; }, "lossy"},
  };
  for (const auto& test : cases) {
    write_stranger(path(), test.change);
    expect_contains(reading_error(path()), test.message);
  }
}

}  // namespace
}  // namespace prt::signal
