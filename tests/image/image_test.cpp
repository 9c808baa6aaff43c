#include "image/image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>

#include "core/error.h"
#include "core/file.h"
#include "core/random.h"
#include "image/srgb.h"
#include "temporary_folder.h"

namespace prt::image {
namespace {

Image random_image(int width, int height, int channels, float scale) {
  Image image(width, height, channels);
  Pcg32 random(7);
  for (float& value : image.pixels) value = scale * random.uniform();
  return image;
}

void write_bytes(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string expect_bad_input(const std::function<void()>& read) {
  try {
    read();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

class ImageFile : public testing::Test {
 protected:
  TemporaryFolder folder_;
};

TEST_F(ImageFile, ExrRoundTripIsExact) {
  for (int channels : {1, 3, 4}) {
    const Image image = random_image(37, 19, channels, 5000);
    write_image(folder_ / "a.exr", image);
    const Image read = read_image(folder_ / "a.exr");
    EXPECT_EQ(read.width, 37);
    EXPECT_EQ(read.height, 19);
    EXPECT_EQ(read.channel_count, channels);
    EXPECT_EQ(read.pixels, image.pixels);
  }
}

TEST_F(ImageFile, PngRoundTripErrsByHalfACodeValue) {
  for (int channels : {1, 2, 3, 4}) {
    const Image image = random_image(37, 19, channels, 1);
    write_image(folder_ / "a.png", image);
    const Image read = read_image(folder_ / "a.png");
    ASSERT_EQ(read.channel_count, channels);
    const int colours = channels > 2 ? 3 : 1;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      const bool colour = static_cast<int>(i % static_cast<std::size_t>(channels)) < colours;
      const float expected = colour ? srgb_from_linear(image.pixels[i]) : image.pixels[i];
      const float found = colour ? srgb_from_linear(read.pixels[i]) : read.pixels[i];
      EXPECT_NEAR(found, expected, 0.5f / 255 + 1e-5f);
    }
  }
}

TEST_F(ImageFile, WritesTheSameBytesTwice) {
  const Image image = random_image(64, 64, 3, 2);
  for (const char* extension : {".exr", ".png"}) {
    const auto a = folder_ / (std::string("a") + extension);
    const auto b = folder_ / (std::string("b") + extension);
    write_image(a, image);
    write_image(b, image);
    EXPECT_EQ(read_file(a), read_file(b));
  }
}

TEST_F(ImageFile, TellsNothingOfWhenItWasWritten) {
  write_image(folder_ / "a.exr", random_image(8, 8, 3, 1));
  const std::string file = read_text_file(folder_ / "a.exr");
  EXPECT_NE(file.find("1970:01:01 00:00:00"), std::string::npos);  // OpenImageIO insists on a date
}

TEST_F(ImageFile, FormatFollowsMagicBytesNotTheName) {
  const Image image = random_image(8, 8, 3, 3);
  write_image(folder_ / "a.exr", image);
  std::filesystem::rename(folder_ / "a.exr", folder_ / "a.png");
  EXPECT_EQ(read_image(folder_ / "a.png").pixels, image.pixels);
}

TEST_F(ImageFile, MemoryTakesPngAndRejectsExr) {
  const Image image = random_image(8, 8, 3, 1);
  write_image(folder_ / "a.png", image);
  write_image(folder_ / "a.exr", image);
  const std::vector<std::byte> png = read_file(folder_ / "a.png");
  EXPECT_EQ(read_image(png, "image 0").pixels, read_image(folder_ / "a.png").pixels);
  const Image data = read_image(png, "image 0", kMaxPixels, Content::data);
  const Image colour = read_image(png, "image 0");
  ASSERT_EQ(data.pixels.size(), colour.pixels.size());
  for (std::size_t i = 0; i < data.pixels.size(); ++i) {
    EXPECT_NEAR(linear_from_srgb(data.pixels[i]), colour.pixels[i], 1e-6f);
  }
  const std::vector<std::byte> exr = read_file(folder_ / "a.exr");
  const std::string message = expect_bad_input([&] { read_image(exr, "image 0"); });
  EXPECT_NE(message.find("image 0"), std::string::npos);
}

TEST_F(ImageFile, DecodesJpeg) {
  const Image image = read_image("data/grey_gradient.jpg");
  ASSERT_EQ(image.width, 16);
  ASSERT_EQ(image.height, 8);
  ASSERT_EQ(image.channel_count, 1);
  for (int x = 0; x < 16; ++x) {  // column x was written as code value 16 x
    EXPECT_NEAR(srgb_from_linear(image.at(x, 4)[0]) * 255, 16.0f * static_cast<float>(x), 4.0f);
  }
}

TEST_F(ImageFile, DecodesRadianceHdr) {
  // Flat RGBE pixels: (128, 64, 32, exponent 128 + 3) is (4, 2, 1).
  write_bytes(folder_ / "a.hdr", std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n") +
                                     "\x80\x40\x20\x83\x80\x40\x20\x83");
  const Image image = read_image(folder_ / "a.hdr");
  ASSERT_EQ(image.pixels.size(), 6u);
  EXPECT_NEAR(image.pixels[0], 4, 0.05);
  EXPECT_NEAR(image.pixels[1], 2, 0.05);
  EXPECT_NEAR(image.pixels[2], 1, 0.05);
}

TEST_F(ImageFile, ReplacesNonFiniteValuesByZero) {
  Image image = random_image(4, 2, 3, 1);
  image.pixels[1] = std::numeric_limits<float>::quiet_NaN();
  image.pixels[5] = std::numeric_limits<float>::infinity();
  write_image(folder_ / "a.exr", image);
  const Image read = read_image(folder_ / "a.exr");
  EXPECT_EQ(read.pixels[1], 0);
  EXPECT_EQ(read.pixels[5], 0);
  EXPECT_EQ(read.pixels[0], image.pixels[0]);
}

TEST_F(ImageFile, RejectsTruncationAnywhere) {
  const Image image = random_image(64, 64, 3, 1);
  write_image(folder_ / "a.exr", image);
  write_image(folder_ / "a.png", image);
  std::filesystem::copy_file("data/grey_gradient.jpg", folder_ / "a.jpg");
  write_bytes(folder_ / "a.hdr",
              "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 4\n" + std::string(64, '\x55'));
  for (const char* name : {"a.exr", "a.png", "a.jpg", "a.hdr"}) {
    const std::vector<std::byte> bytes = read_file(folder_ / name);
    EXPECT_NO_THROW(read_image(folder_ / name)) << name;
    for (std::size_t part = 0; part < 20; ++part) {
      std::filesystem::resize_file(folder_ / name, bytes.size() * (19 - part) / 20);
      const std::string message = expect_bad_input([&] { read_image(folder_ / name); });
      EXPECT_NE(message.find(name), std::string::npos) << message;
    }
  }
}

TEST_F(ImageFile, ReadsOrRejectsButNeverCrashesOnFlippedBytes) {
  const Image image = random_image(32, 32, 3, 1);
  Pcg32 random(3);
  int rejected_count = 0;
  for (const char* name : {"a.exr", "a.png"}) {
    write_image(folder_ / name, image);
    const std::vector<std::byte> bytes = read_file(folder_ / name);
    for (int i = 0; i < 200; ++i) {
      std::vector<std::byte> damaged = bytes;
      damaged[random.below(static_cast<std::uint32_t>(bytes.size()))] ^=
          static_cast<std::byte>(1 + random.below(255));
      write_bytes(folder_ / "damaged", {reinterpret_cast<char*>(damaged.data()), damaged.size()});
      try {
        read_image(folder_ / "damaged", 1 << 20);
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_input) << error.what();
        ++rejected_count;
      }
    }
  }
  EXPECT_GT(rejected_count, 100);
}

TEST_F(ImageFile, RejectsHugeHeaderClaims) {
  // Only the header of a PNG: length, IHDR, width and height, 8 bit RGB, checksum. libpng itself
  // rejects 16M x 16M pixels, and our limit 900,000 x 900,000.
  const std::string start("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR", 16);
  const std::string type("\x08\x02\0\0\0", 5);
  write_bytes(folder_ / "a.png",
              start + std::string("\1\0\0\0\1\0\0\0", 8) + type + "\x7e\x04\x26\x83");
  expect_bad_input([&] { read_image(folder_ / "a.png"); });
  const std::string data = std::string("\0\0\0\x08IDAT", 8) + std::string(12, '\0') +
                           std::string("\0\0\0\0IEND\xae\x42\x60\x82", 12);
  const std::string sides("\x00\x0d\xbb\xa0\x00\x0d\xbb\xa0", 8);
  write_bytes(folder_ / "a.png", start + sides + type + "\x5f\xdf\x06\xd8" + data);
  const std::string message = expect_bad_input([&] { read_image(folder_ / "a.png"); });
  EXPECT_NE(message.find("found 900000 x 900000 pixels"), std::string::npos) << message;
  write_bytes(folder_ / "a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16777216 +X 16777216\n");
  expect_bad_input([&] { read_image(folder_ / "a.hdr"); });

  write_image(folder_ / "a.exr", random_image(4, 4, 3, 1));
  std::vector<std::byte> exr = read_file(folder_ / "a.exr");
  const std::string_view text(reinterpret_cast<const char*>(exr.data()), exr.size());
  for (const char* attribute : {"dataWindow", "displayWindow"}) {
    const std::size_t at = text.find(attribute);
    ASSERT_NE(at, std::string_view::npos);
    const std::size_t box = at + std::string_view(attribute).size() + 1 + 6 + 4;  // "box2i\0", size
    for (std::size_t corner : {8, 12}) {
      exr[box + corner + 0] = exr[box + corner + 1] = exr[box + corner + 2] = std::byte{0xff};
    }
  }
  write_bytes(folder_ / "a.exr", {reinterpret_cast<const char*>(exr.data()), exr.size()});
  expect_bad_input([&] { read_image(folder_ / "a.exr"); });
}

TEST_F(ImageFile, RejectsMorePixelsThanTheFileCanHoldBeforeTakingMemory) {
  // 16000 x 16000 pixels are within the limit.
  const std::string png =
      std::string("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\x3e\x80\0\0\x3e\x80\x08\x02\0\0\0", 29) +
      "\xce\x1c\x48\x89" + std::string("\0\0\0\x08IDAT", 8) + std::string(12, '\0') +
      std::string("\0\0\0\0IEND\xae\x42\x60\x82", 12);
  write_bytes(folder_ / "a.png", png);
  write_bytes(folder_ / "a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16000 +X 16000\n");
  for (const char* name : {"a.png", "a.hdr"}) {
    const std::string message = expect_bad_input([&] { read_image(folder_ / name); });
    EXPECT_NE(message.find("bytes for 16000 x 16000 pixels"), std::string::npos) << message;
  }
}

TEST_F(ImageFile, ReadsWhatCompressesWell) {
  for (const char* name : {"a.png", "a.exr"}) {
    write_image(folder_ / name, Image(2048, 2048, 3));
    EXPECT_EQ(read_image(folder_ / name).width, 2048);
  }
}

TEST_F(ImageFile, PixelLimitIsInclusive) {
  write_image(folder_ / "a.png", random_image(8, 8, 3, 1));
  EXPECT_NO_THROW(read_image(folder_ / "a.png", 64));
  const std::string message = expect_bad_input([&] { read_image(folder_ / "a.png", 63); });
  EXPECT_NE(message.find("found 8 x 8 pixels, expected 1 to 63 pixels"), std::string::npos)
      << message;
}

TEST_F(ImageFile, RejectsWhatIsNoImage) {
  expect_bad_input([&] { read_image(folder_ / "missing.png"); });
  expect_bad_input([&] { read_image(folder_.path()); });
  write_bytes(folder_ / "a.png", "");
  expect_bad_input([&] { read_image(folder_ / "a.png"); });
  write_bytes(folder_ / "a.png", "GIF89a");
  expect_bad_input([&] { read_image(folder_ / "a.png"); });
}

TEST_F(ImageFile, WritingFailsCleanly) {
  const Image image = random_image(4, 4, 3, 1);
  EXPECT_THROW(write_image(folder_ / "no" / "a.png", image), Error);
  try {
    write_image(folder_ / "a.gif", image);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
  }
  write_image(folder_ / "a.png", image);
  EXPECT_THROW(write_image(folder_ / "a.png", image, true), Error);
  std::size_t file_count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    EXPECT_EQ(entry.path().filename(), "a.png");
    ++file_count;
  }
  EXPECT_EQ(file_count, 1u);
}

}  // namespace
}  // namespace prt::image
