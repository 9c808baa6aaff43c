#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "core/error.h"
#include "core/file.h"
#include "sh/directions.h"
#include "sh/light.h"
#include "temporary_folder.h"

namespace prt::sh {
namespace {

class LightFile : public testing::Test {
 protected:
  void write(const std::string& text) const { std::ofstream(path_, std::ios::binary) << text; }

  /// The message of the error that reading `text` gives.
  std::string rejection(const std::string& text) const {
    write(text);
    try {
      read_light(path_);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      EXPECT_NE(std::string(error.what()).find("light.json"), std::string::npos);
      return error.what();
    }
    ADD_FAILURE() << "accepted: " << text;
    return {};
  }

  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "light.json";
};

std::string one_band(const std::string& red, const std::string& head = "\"prtkit_light\": 1") {
  return "{" + head + ", \"band_count\": 1, \"coefficients\": {\"r\": " + red +
         ", \"g\": [2], \"b\": [3.5e-1]}}";
}

#define EXPECT_MENTIONS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST_F(LightFile, RoundTripIsExact) {
  Pcg32 random(41);
  Light light(7);
  for (auto& channel : light.coefficients) {
    channel = random_coefficients(49, random);
    for (std::size_t i = 0; i < 49; ++i) channel[i] *= std::pow(10.0f, static_cast<float>(i) - 24);
  }
  light.source = "a \"quoted\" näme\n";
  write_light(path_, light);
  const Light read = read_light(path_);
  EXPECT_EQ(read.band_count, 7);
  EXPECT_EQ(read.coefficients, light.coefficients);
  EXPECT_EQ(read.source, light.source);
}

TEST_F(LightFile, ReadsTheExampleOfTheDocumentation) {
  const std::string page = read_text_file("../docs/light-file.md");
  const std::size_t fence = page.find("```json\n");
  ASSERT_NE(fence, std::string::npos);
  write(page.substr(fence + 8, page.find("```", fence + 8) - fence - 8));
  const Light light = read_light(path_);
  ASSERT_EQ(light.band_count, 3);
  // The page's table of test vectors: | (x, y, z) | r | g | b |
  int row_count = 0;
  for (std::size_t row = page.find("| ("); row != std::string::npos;
       row = page.find("| (", row + 1)) {
    Vec3 d, expected;
    ASSERT_EQ(std::sscanf(page.c_str() + row, "| (%f, %f, %f) | %f | %f | %f |", &d.x, &d.y, &d.z,
                          &expected.x, &expected.y, &expected.z),
              6);
    const Vec3 radiance = light_radiance(light, d);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(radiance[c], expected[c], 2e-6f);
    ++row_count;
  }
  EXPECT_EQ(row_count, 5);
}

TEST_F(LightFile, AcceptsTheSmallestFile) {
  write(one_band("[1]"));
  const Light light = read_light(path_);
  EXPECT_EQ(light.coefficients[0][0], 1);
  EXPECT_EQ(light.coefficients[1][0], 2);
  EXPECT_EQ(light.coefficients[2][0], 0.35f);
}

TEST_F(LightFile, RejectsWhatIsNoJson) {
  for (const char* text : {"", "{", "light", "\xff\xfe", "[1] 2", "{\"prtkit_light\": 1,}"}) {
    EXPECT_MENTIONS(rejection(text), "no valid JSON");
  }
}

TEST_F(LightFile, RejectsWrongTypes) {
  EXPECT_MENTIONS(rejection("[]"), "found array, expected an object");
  EXPECT_MENTIONS(rejection("{}"), "\"prtkit_light\"");
  EXPECT_MENTIONS(rejection(one_band("[1]", "\"prtkit_light\": 2")), "found 2, expected 1");
  EXPECT_MENTIONS(rejection(one_band("[1]", "\"prtkit_light\": \"1\"")), "found string");
  EXPECT_MENTIONS(rejection(one_band("[1]", "\"prtkit_light\": 1, \"source\": 3")), "\"source\"");
  EXPECT_MENTIONS(rejection(one_band("1")), "\"coefficients\".\"r\"");
  EXPECT_MENTIONS(rejection(one_band("[null]")), "found null, expected a number");
  EXPECT_MENTIONS(rejection(one_band("[\"1\"]")), "found string");
  EXPECT_MENTIONS(rejection("{\"prtkit_light\": 1, \"band_count\": 1}"), "\"coefficients\"");
  EXPECT_MENTIONS(
      rejection("{\"prtkit_light\": 1, \"band_count\": 1, \"coefficients\": {\"r\": [1]}}"),
      "\"coefficients\".\"g\"");
}

TEST_F(LightFile, RejectsWrongCounts) {
  EXPECT_MENTIONS(rejection(one_band("[]")), "found 0 numbers");
  EXPECT_MENTIONS(rejection(one_band("[1, 2]")), "found 2 numbers");
  for (const char* count : {"0", "-1", "17", "2147483648", "9223372036854775807"}) {
    const std::string text = std::string("{\"prtkit_light\": 1, \"band_count\": ") + count +
                             ", \"coefficients\": {\"r\": [1], \"g\": [1], \"b\": [1]}}";
    EXPECT_MENTIONS(rejection(text), "expected 1 to 16");
  }
  EXPECT_MENTIONS(rejection("{\"prtkit_light\": 1, \"band_count\": 1.5}"), "an integer");
}

TEST_F(LightFile, RejectsNumbersThatAreNotFiniteFloats) {
  EXPECT_MENTIONS(rejection(one_band("[NaN]")), "no valid JSON");
  EXPECT_MENTIONS(rejection(one_band("[1e999]")), "no valid JSON");
  EXPECT_MENTIONS(rejection(one_band("[1e39]")), "a finite float32");
  EXPECT_MENTIONS(rejection(one_band("[-1e39]")), "a finite float32");
}

TEST_F(LightFile, RejectsDeepNestingAndLargeFiles) {
  EXPECT_MENTIONS(rejection(std::string(100000, '[')), "nested too deeply");
  EXPECT_MENTIONS(rejection(std::string(2 << 20, ' ')), "file too large");
}

TEST_F(LightFile, RejectsAMissingFile) { EXPECT_THROW(read_light(folder_ / "no.json"), Error); }

TEST_F(LightFile, WritingKeepsAnExistingFileWhenAsked) {
  write("mine");
  EXPECT_THROW(write_light(path_, Light(1), true), Error);
  EXPECT_EQ(read_text_file(path_), "mine");
  EXPECT_THROW(write_light(folder_ / "no" / "light.json", Light(1)), Error);
}

}  // namespace
}  // namespace prt::sh
