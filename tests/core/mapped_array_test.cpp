#include "core/mapped_array.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <limits>
#include <numeric>
#include <random>
#include <set>

#include "core/error.h"
#include "core/parallel.h"
#include "core/spatial_order.h"

namespace prt {
namespace {

const std::filesystem::path kInMemory, kOnDisk = std::filesystem::temp_directory_path();

/// Pages of files in the memory of this process.
std::size_t resident_file_bytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t total = 0, resident = 0, shared = 0;
  file >> total >> resident >> shared;
  return shared * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

TEST(MappedArray, IsAnArrayOfZerosThatGrows) {
  for (const auto& folder : {kInMemory, kOnDisk}) {
    MappedArray<std::uint32_t> array(0, folder);
    EXPECT_TRUE(array.empty());
    for (std::uint32_t i = 0; i < 100'000; ++i) array.push_back(i);
    array.resize(300'000);
    for (std::uint32_t i = 0; i < array.size(); ++i) ASSERT_EQ(array[i], i < 100'000 ? i : 0);
    MappedArray<std::uint32_t> other(3, folder);
    other[1] = 7;
    std::swap(array, other);
    EXPECT_EQ(array.size(), 3u);
    EXPECT_EQ(array[1], 7u);
    EXPECT_EQ(other[99'999], 99'999u);
    const MappedArray<std::uint32_t> moved = std::move(other);
    EXPECT_EQ(moved.size(), 300'000u);
    EXPECT_TRUE(other.empty());
  }
}

TEST(MappedArray, TrimmingTakesItOutOfMemoryAndLosesNothing) {
  constexpr std::size_t kMegabyte = std::size_t{1} << 20, kCount = 4 * kMegabyte;  // 32 MB each
  constexpr std::size_t kBudget = 4 * kMegabyte;
  const std::size_t before = resident_file_bytes();
  MappedArray<std::uint64_t> array(kCount, kOnDisk), other(kCount, kOnDisk);
  std::iota(array.begin(), array.end(), std::uint64_t{5});
  trim_mapped_arrays();  // below its budget
  EXPECT_GT(resident_file_bytes(), before + 24 * kMegabyte);
  std::iota(other.begin(), other.end(), std::uint64_t{5});
  trim_mapped_arrays(kBudget);
  EXPECT_LT(resident_file_bytes(), before + kBudget);
  parallel_for(kCount, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) array[i] += other[i];
    trim_mapped_arrays(kBudget);
  });
  std::size_t most = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    ASSERT_EQ(array[i], 2 * (i + 5));
    if (i % 4096 > 0) continue;
    trim_mapped_arrays(kBudget);
    most = std::max(most, resident_file_bytes());
  }
  EXPECT_LT(most, before + 24 * kMegabyte);
}

TEST(MappedArray, ThreadsMayTrimWhileOthersWrite) {
  MappedArray<std::uint32_t> array(std::size_t{4} << 20, kOnDisk);
  for (int pass = 0; pass < 3; ++pass) {
    parallel_for(array.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) array[i] += static_cast<std::uint32_t>(i);
      trim_mapped_arrays(0);
    });
  }
  for (std::uint32_t i = 0; i < array.size(); ++i) ASSERT_EQ(array[i], 3 * i);
}

/// A limit on the size of files stands for a full disk.
TEST(MappedArray, AFullDiskIsAnErrorBeforeAnythingIsWritten) {
  EXPECT_THROW(MappedArray<float>(1, "/nowhere"), Error);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  MappedArray<float> array(1000, kOnDisk);
  array[999] = 3.0f;
  const rlimit small{1 << 20, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  try {
    array.resize(1 << 20);
    ADD_FAILURE() << "there was room";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::failed);
    EXPECT_NE(std::string(error.what()).find("no room"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("5 MB"), std::string::npos) << error.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(array.size(), 1000u);
  EXPECT_EQ(array[999], 3.0f);
}

std::vector<std::uint32_t> order_of(const std::vector<Vec3>& points,
                                    const std::filesystem::path& folder) {
  const auto point = [&](std::size_t i) { return points[i]; };
  const auto order = spatial_order({points.size(), point}, points.size(), point, folder);
  return {order.begin(), order.end()};
}

TEST(SpatialOrder, IsAPermutationAndTakesAnyInput) {
  for (const auto& folder : {kInMemory, kOnDisk}) {
    EXPECT_TRUE(order_of({}, folder).empty());
    const std::vector<Vec3> same(5, Vec3(3.0f));
    EXPECT_EQ(order_of(same, folder), (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
    std::vector<Vec3> points;
    std::mt19937 random(1);
    for (int i = 0; i < 20'000; ++i) {
      points.emplace_back(static_cast<float>(random() % 30), static_cast<float>(random() % 1000),
                          1e-3f * static_cast<float>(random() % 1000));
    }
    const std::vector<std::uint32_t> order = order_of(points, folder);
    EXPECT_EQ(std::set<std::uint32_t>(order.begin(), order.end()).size(), points.size());
    double step = 0.0;
    for (std::size_t i = 1; i < order.size(); ++i) {
      step += (points[order[i]] - points[order[i - 1]]).length();
    }
    EXPECT_LT(step / static_cast<double>(order.size()), 8.0);  // at random 330
  }
}

/// Along the curve, cell by cell; equal cells in input order.
TEST(SpatialOrder, FollowsTheCurve) {
  std::vector<Vec3> points;
  for (int i = 15; i >= 0; --i) {
    points.emplace_back(static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1),
                        static_cast<float>(i >> 2 & 1));
  }
  const std::vector<std::uint32_t> order = order_of(points, kInMemory);
  EXPECT_EQ(order,
            (std::vector<std::uint32_t>{7, 15, 6, 14, 5, 13, 4, 12, 3, 11, 2, 10, 1, 9, 0, 8}));
}

/// Most of them in a thousandth of the cube, most of these in one cell.
TEST(SpatialOrder, SortsMorePointsThanItSortsAtATime) {
  std::vector<Vec3> points(2'300'000);
  std::mt19937 random(2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float extent = i % 16 == 0 ? 1.0f : i % 16 < 8 ? 1e-3f : 0.0f;
    const float x = static_cast<float>(random() % 4096), y = static_cast<float>(random() % 4096);
    points[i] = Vec3(0.3f) + Vec3(x, y, x) * (extent / 4096.0f);
  }
  const SpatialGrid grid(points.size(), [&](std::size_t i) { return points[i]; });
  std::vector<std::uint64_t> cells(points.size());
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = grid.cell(points[i]);
  const std::vector<std::uint32_t> order = order_of(points, kOnDisk);
  ASSERT_EQ(order.size(), points.size());
  for (std::size_t i = 1; i < order.size(); ++i) {
    const std::uint32_t a = order[i - 1], b = order[i];
    ASSERT_TRUE(cells[a] < cells[b] || (cells[a] == cells[b] && a < b)) << i;
  }
}

}  // namespace
}  // namespace prt
