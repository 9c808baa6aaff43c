#include "brdf/matrix_cache.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>

#include "core/file.h"
#include "core/hash.h"

namespace prt::brdf {
namespace {

namespace fs = std::filesystem;

class MatrixCache : public testing::Test {
 protected:
  MatrixCache()
      : folder_(fs::temp_directory_path() / ("prtkit-cache-" + std::to_string(getpid()))) {}
  ~MatrixCache() override { fs::remove_all(folder_); }

  LobeMatrix get(const Lobe& lobe, int rows = 2, double tolerance = 1e-3) const {
    return cached_lobe_matrix(lobe, rows, 3, tolerance, folder_ / "deep" / "er");
  }
  std::vector<fs::path> files() const {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      if (entry.is_regular_file()) paths.push_back(entry.path());
    }
    return paths;
  }
  static void overwrite(const fs::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
  }

  fs::path folder_;
};

void expect_equal(const LobeMatrix& a, const LobeMatrix& b) {
  EXPECT_EQ(a.values, b.values);
  EXPECT_EQ(a.row_band_count, b.row_band_count);
  EXPECT_EQ(a.column_band_count, b.column_band_count);
  EXPECT_EQ(a.error, b.error);
  EXPECT_EQ(a.exit_energy, b.exit_energy);
  EXPECT_EQ(a.kernel_energy, b.kernel_energy);
}

TEST_F(MatrixCache, GivesBackTheSameMatrix) {
  const auto lobe = ggx(0.5, 0.5);
  const LobeMatrix first = get(*lobe);
  expect_equal(first, compute_lobe_matrix(*lobe, 2, 3, 1e-3));
  ASSERT_EQ(files().size(), 1u);
  const auto written = fs::last_write_time(files()[0]);
  expect_equal(get(*lobe), first);
  EXPECT_EQ(fs::last_write_time(files()[0]), written);
}

// Numbers exchanged under a correct hash show up; another lobe's whole file does not.
TEST_F(MatrixCache, ReadsTheFileOfThisLobeOnly) {
  const auto lobe = lambert();
  const LobeMatrix wanted = get(*lobe);
  const fs::path path = files()[0];
  std::string body = read_text_file(path);
  body.resize(body.size() - 32);
  const double marked = 17;
  std::memcpy(&body[body.size() - sizeof(double)], &marked, sizeof(double));
  Hasher hasher;
  hasher.add(body.data(), body.size());
  overwrite(path, body + hasher.hex());
  EXPECT_EQ(get(*lobe).values.back(), 17);

  get(*phong(3));
  ASSERT_EQ(files().size(), 2u);
  fs::copy_file(files()[0] == path ? files()[1] : files()[0], path,
                fs::copy_options::overwrite_existing);
  expect_equal(get(*lobe), wanted);
}

TEST_F(MatrixCache, KeepsWhatDiffersApart) {
  get(*ggx(0.5, 0.5));
  get(*ggx(0.5, 0.6));
  get(*ggx(0.5, 0.5), 3);
  get(*ggx(0.5, 0.5), 2, 1e-2);
  EXPECT_EQ(files().size(), 4u);
}

TEST_F(MatrixCache, ReplacesBrokenFiles) {
  const auto lobe = ward(0.5, 0.5);
  const LobeMatrix wanted = get(*lobe);
  const fs::path path = files()[0];
  const std::string good = read_text_file(path);
  std::string flipped = good;
  flipped[good.size() / 2] = static_cast<char>(flipped[good.size() / 2] ^ 1);
  for (const std::string& bad :
       {std::string(), std::string("garbage"), good.substr(0, good.size() - 1), good + "x",
        std::string(good.size(), '\0'), flipped}) {
    overwrite(path, bad);
    expect_equal(get(*lobe), wanted);
    EXPECT_EQ(read_text_file(path), good);
  }
}

TEST_F(MatrixCache, ComputesWhereNothingCanBeWritten) {
  const auto lobe = lambert();
  fs::create_directories(folder_);
  overwrite(folder_ / "file", "x");
  const LobeMatrix matrix = cached_lobe_matrix(*lobe, 2, 2, 1e-3, folder_ / "file" / "in");
  expect_equal(matrix, compute_lobe_matrix(*lobe, 2, 2, 1e-3));
  expect_equal(cached_lobe_matrix(*lobe, 2, 2, 1e-3, {}), matrix);
  EXPECT_EQ(files().size(), 1u);
}

TEST_F(MatrixCache, FolderFollowsTheXdgRules) {
  const auto restore = [](const char* name) {
    const char* value = std::getenv(name);
    return std::pair(name, value ? std::string(value) : std::string());
  };
  const auto saved = {restore("XDG_CACHE_HOME"), restore("HOME")};
  setenv("HOME", "/home/someone", 1);
  setenv("XDG_CACHE_HOME", "/elsewhere", 1);
  EXPECT_EQ(default_cache_folder(), "/elsewhere/prtkit/brdf");
  setenv("XDG_CACHE_HOME", "relative", 1);
  EXPECT_EQ(default_cache_folder(), "/home/someone/.cache/prtkit/brdf");
  unsetenv("XDG_CACHE_HOME");
  EXPECT_EQ(default_cache_folder(), "/home/someone/.cache/prtkit/brdf");
  unsetenv("HOME");
  EXPECT_EQ(default_cache_folder(), "");
  for (const auto& [name, value] : saved) {
    if (!value.empty()) setenv(name, value.c_str(), 1);
  }
}

}  // namespace
}  // namespace prt::brdf
