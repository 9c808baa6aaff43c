// What the tests of transfer files share.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/random.h"
#include "signal/transfer_signal.h"

namespace prt::signal {

namespace fs = std::filesystem;

class TransferFile : public testing::Test {
 protected:
  TransferFile() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("transfer_") + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~TransferFile() override { fs::remove_all(folder_); }
  fs::path path(const char* name = "a.transfer.exr") const { return folder_ / name; }

  fs::path folder_;
};

inline TransferSignal make_signal(int band_count, int row_count, int channel_count,
                                  const std::vector<std::size_t>& vertex_counts) {
  TransferSignal signal{.band_count = band_count,
                        .row_count = row_count,
                        .channel_count = channel_count,
                        .seed = 0xfedcba9876543210u,
                        .ray_count = 2048,
                        .bounce_count = 2,
                        .tool_version = "0.1.0",
                        .mesh_hash = "0123456789abcdef0123456789abcdef",
                        .blocks = {},
                        .values = {}};
  for (std::size_t count : vertex_counts) {
    signal.blocks.push_back({"part " + std::to_string(signal.blocks.size()), count});
  }
  Pcg32 random(7);
  signal.values.resize(signal.vertex_count() * static_cast<std::size_t>(signal.dimension()));
  for (float& value : signal.values) value = random.uniform() - 0.5f;
  return signal;
}

/// The message of the error that reading gives.
inline std::string reading_error(const fs::path& path) {
  try {
    read_transfer(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_EQ(error.details().file, path.string());
    return error.what();
  }
  ADD_FAILURE() << "was read without an error";
  return {};
}

inline void expect_contains(const std::string& message, const std::string& part) {
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

}  // namespace prt::signal
