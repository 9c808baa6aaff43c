#include "core/file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/checked.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/random.h"
#include "core/report.h"

namespace prt {
namespace {

TEST(ReadFile, RejectsMissingFilesFoldersAndLargeFiles) {
  EXPECT_THROW(read_file("no/such/file"), Error);
  EXPECT_THROW(read_file("."), Error);
  EXPECT_THROW(read_file("core/file_test.cpp", 10), Error);
  EXPECT_GT(read_file("core/file_test.cpp").size(), 10u);
}

TEST(LowerExtension, IsTheEndingWithItsDotInLowerCase) {
  EXPECT_EQ(lower_extension("A/B.C.GlB"), ".glb");
  EXPECT_EQ(lower_extension("a.\xc9"), ".\xc9");
  EXPECT_EQ(lower_extension("a.EXR/b"), "");
}

TEST(Checked, OverflowIsAnErrorInsteadOfAWrap) {
  EXPECT_EQ(checked_multiply(3, 5), 15u);
  EXPECT_EQ(checked_add(3, 5), 8u);
  EXPECT_THROW(checked_multiply(std::size_t{1} << 40, std::size_t{1} << 40), Error);
  EXPECT_THROW(checked_add(~std::size_t{0}, 1), Error);
}

TEST(Hasher, MatchesThePublishedXxh3OfNothingAndIsIncremental) {
  EXPECT_EQ(Hasher().hex(), "99aa06d3014798d86001c324468d497f");
  Hasher whole, parts;
  whole.add("abcdef", 6);
  parts.add("abc", 3);
  parts.add("def", 3);
  EXPECT_EQ(whole.hex(), parts.hex());
}

TEST(Pcg32, MatchesTheAuthorsDemoSequence) {
  Pcg32 random(42, 54);
  for (const std::uint32_t expected :
       {0xa15c02b7u, 0x7b47f409u, 0xba1d3330u, 0x83d2f293u, 0xbfa4784bu, 0xcbed606eu}) {
    EXPECT_EQ(random.next(), expected);
  }
}

TEST(Report, HoldsInputsStagesAndPeakMemory) {
  const std::filesystem::path path = testing::TempDir() + "prtkit-report.json";
  Report report("test");
  report.add_input("core/file_test.cpp");
  { const StageTimer timer(report, "work"); }
  report.write(path, false);
  const auto json = nlohmann::json::parse(read_text_file(path));
  EXPECT_EQ(json["inputs"][0]["hash"], hash_file("core/file_test.cpp"));
  EXPECT_EQ(json["stages"][0]["name"], "work");
  EXPECT_GT(json["peak_memory_bytes"], 0);
  std::filesystem::remove(path);
}

TEST(Report, ReplacesBytesThatAreNotUtf8) {
  const std::filesystem::path input = testing::TempDir() + "prtkit-\xe4.txt";
  const std::filesystem::path path = testing::TempDir() + "prtkit-report.json";
  std::ofstream(input) << "text";
  Report report("test");
  report.add_input(input);
  report.write(path, false);
  const auto json = nlohmann::json::parse(read_text_file(path));
  EXPECT_EQ(json["inputs"][0]["path"], testing::TempDir() + "prtkit-\ufffd.txt");
  std::filesystem::remove(path);
  std::filesystem::remove(input);
}

}  // namespace
}  // namespace prt
