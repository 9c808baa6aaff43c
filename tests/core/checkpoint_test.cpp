#include "core/checkpoint.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <vector>

#include "core/file.h"
#include "temporary_folder.h"

namespace prt {
namespace {

namespace fs = std::filesystem;

class CheckpointTest : public testing::Test {
 protected:
  std::vector<int> result(std::uint32_t index) const {
    return std::vector<int>(100 + 10 * index, static_cast<int>(index));
  }
  void store(Checkpoint& checkpoint, std::uint32_t index) const {
    const std::vector<int> values = result(index);
    checkpoint.store({3, index}, std::span<const int>(values));
  }
  /// Whether the result is there, and right.
  bool has(const Checkpoint& checkpoint, std::uint32_t index) const {
    std::vector<int> values(result(index).size(), -1);
    if (!checkpoint.restore({3, index}, std::span(values))) return false;
    EXPECT_EQ(values, result(index));
    return true;
  }
  /// A file with results 0 to 4.
  void write_five() const {
    Checkpoint checkpoint(options_, "key");
    for (std::uint32_t i = 0; i < 5; ++i) store(checkpoint, i);
  }
  std::vector<bool> found(const std::string& key = "key") const {
    const Checkpoint checkpoint(options_, key);
    std::vector<bool> found;
    for (std::uint32_t i = 0; i < 5; ++i) found.push_back(has(checkpoint, i));
    return found;
  }

  const TemporaryFolder folder_;
  const fs::path path_ = folder_ / "out.partial";
  const CheckpointOptions options_{path_, 0.0};
};

TEST_F(CheckpointTest, GivesBackWhatAnEarlierRunHasStored) {
  write_five();
  EXPECT_EQ(found(), std::vector<bool>(5, true));
  Checkpoint checkpoint({path_, 1e9}, "key");  // continued, so nothing waits
  store(checkpoint, 5);
  EXPECT_TRUE(has(checkpoint, 5));
  EXPECT_FALSE(has(checkpoint, 6));
  std::vector<int> longer(101);
  EXPECT_FALSE(checkpoint.restore({3, 0}, std::span(longer)));
}

TEST_F(CheckpointTest, MakesNoFileBeforeItsTimeOrWithoutAPath) {
  Checkpoint late({path_, 1e9}, "key"), none({}, "key");
  for (Checkpoint* checkpoint : {&late, &none}) {
    store(*checkpoint, 0);
    EXPECT_FALSE(has(*checkpoint, 0));
  }
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

/// A state of 4000 bytes, or more.
void store_state(Checkpoint& checkpoint, int value, std::size_t count = 1000) {
  const std::vector<int> state(count, value);
  checkpoint.store({0, 0}, std::span<const int>(state));
}

int state_of(const Checkpoint& checkpoint) {
  std::vector<int> state;
  if (!checkpoint.restore({0, 0}, state)) return -1;
  EXPECT_EQ(state, std::vector<int>(state.size(), state.at(0)));
  return state[0];
}

TEST_F(CheckpointTest, AStateIsReplacedInTheRoomOfAnother) {
  Checkpoint checkpoint(options_, "key");
  for (int i = 0; i < 5; ++i) {
    store_state(checkpoint, i);
    store(checkpoint, 1);
    EXPECT_EQ(state_of(checkpoint), i);
  }
  EXPECT_LT(fs::file_size(path_), 2 * 4000u + 3 * 500u);
  EXPECT_TRUE(has(checkpoint, 1));
}

// Whatever is torn while a state is written, there is one: the new or the one before.
TEST_F(CheckpointTest, AKillWhileAStateIsReplacedLeavesTheOneBefore) {
  std::vector<std::string> files;
  for (int i = 0; i < 4; ++i) {
    Checkpoint(options_, "key").store({0, 0}, std::span<const int>(std::vector<int>(1000, i)));
    files.push_back(read_text_file(path_));
  }
  ASSERT_EQ(files[2].size(), files[3].size());
  std::size_t older = 0;
  for (std::size_t cut = 0; cut < files[3].size(); cut += 97) {
    folder_.write("out.partial", files[3].substr(0, cut) + files[2].substr(cut));
    const Checkpoint checkpoint(options_, "key");
    const int state = state_of(checkpoint);
    EXPECT_TRUE(state == 2 || state == 3) << state;
    older += state == 2;
  }
  EXPECT_GT(older, 10u);
}

TEST_F(CheckpointTest, AStateMayChangeItsSize) {
  {
    Checkpoint checkpoint(options_, "key");
    store_state(checkpoint, 1);
    store(checkpoint, 1);
    store_state(checkpoint, 2, 2000);
    EXPECT_EQ(state_of(checkpoint), 2);
  }
  const Checkpoint checkpoint(options_, "key");
  EXPECT_EQ(state_of(checkpoint), 2);
  EXPECT_TRUE(has(checkpoint, 1));
}

TEST_F(CheckpointTest, AStateThatGrowsTakesTheRoomOfThoseBefore) {
  std::size_t count = 1000;
  {
    Checkpoint checkpoint(options_, "key");
    store(checkpoint, 1);
    for (int i = 0; i < 30; ++i, count += 100) {
      store_state(checkpoint, i, count);
      EXPECT_EQ(state_of(checkpoint), i);
    }
  }
  EXPECT_LT(fs::file_size(path_), 3 * 4 * count);
  {
    Checkpoint continued(options_, "key");
    EXPECT_EQ(state_of(continued), 29);
    EXPECT_TRUE(has(continued, 1));
    for (int i = 30; i < 60; ++i, count -= 60) store_state(continued, i, count);
  }
  EXPECT_LT(fs::file_size(path_), 3 * 4 * 4000u);
  const Checkpoint checkpoint(options_, "key");
  EXPECT_EQ(state_of(checkpoint), 59);
  EXPECT_TRUE(has(checkpoint, 1));
}

TEST_F(CheckpointTest, ReleasedRoomIsUsedAgain) {
  write_five();
  const auto size = fs::file_size(path_);
  {
    Checkpoint checkpoint(options_, "key");
    EXPECT_EQ(checkpoint.byte_count(3), 4 * (100u + 110 + 120 + 130 + 140));
    checkpoint.release(3);
    EXPECT_EQ(checkpoint.byte_count(3), 0u);
    EXPECT_FALSE(has(checkpoint, 0));
    for (std::uint32_t i = 0; i < 5; ++i) {
      checkpoint.store({4, i}, std::span<const int>(result(i)));
    }
  }
  EXPECT_EQ(fs::file_size(path_), size);
  EXPECT_EQ(found(), std::vector<bool>(5, false));
  EXPECT_EQ(Checkpoint(options_, "key").byte_count(4), 4 * (100u + 110 + 120 + 130 + 140));
}

TEST_F(CheckpointTest, AnotherKeyStartsAnew) {
  write_five();
  EXPECT_EQ(found("other"), std::vector<bool>(5, false));
  EXPECT_EQ(found(), std::vector<bool>(5, true));  // looking has destroyed nothing
  {
    Checkpoint other(options_, "other");
    store(other, 1);
  }
  EXPECT_EQ(found(), std::vector<bool>(5, false));
  EXPECT_EQ(found("other"), (std::vector<bool>{false, true, false, false, false}));
}

// Cut anywhere, the file holds the results before the cut; and continuing it makes it whole.
TEST_F(CheckpointTest, ATornEndIsIgnored) {
  write_five();
  const std::string whole = read_text_file(path_);
  std::size_t most = 0;
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    folder_.write("out.partial", whole.substr(0, size));
    const std::vector<bool> there = found();
    const auto count = static_cast<std::size_t>(std::count(there.begin(), there.end(), true));
    EXPECT_EQ(std::find(there.begin(), there.end(), false) - there.begin(), count);
    EXPECT_GE(count, most);
    most = count;
    if (size % 10 == 0) {
      {
        Checkpoint checkpoint(options_, "key");
        for (std::uint32_t i = 0; i < 5; ++i) {
          if (!has(checkpoint, i)) store(checkpoint, i);
        }
      }
      EXPECT_TRUE(read_text_file(path_) == whole) << size;
    }
  }
  EXPECT_EQ(most, 4u);
}

TEST_F(CheckpointTest, DamagedResultsAreNotThere) {
  write_five();
  const std::string whole = read_text_file(path_);
  std::size_t lost = 0;
  for (std::size_t at = 0; at < whole.size(); at += 11) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x40);
    folder_.write("out.partial", damaged);
    const std::vector<bool> there = found();  // checks the values of those that are
    lost += std::count(there.begin(), there.end(), false) > 0;
  }
  EXPECT_EQ(lost, (whole.size() + 10) / 11);
}

TEST_F(CheckpointTest, LeavesWhatIsNoCheckpointAlone) {
  folder_.write("out.partial", "the user's own");
  {
    Checkpoint checkpoint(options_, "key");
    store(checkpoint, 0);
    EXPECT_FALSE(has(checkpoint, 0));
  }
  remove_checkpoint(path_);
  EXPECT_EQ(read_text_file(path_), "the user's own");
  fs::remove(path_);
  fs::create_symlink(folder_.write("target", ""), path_);
  Checkpoint linked(options_, "key");
  store(linked, 0);
  EXPECT_EQ(fs::file_size(folder_ / "target"), 0u);
}

TEST_F(CheckpointTest, IsRemovedWhenTheOutputIsWritten) {
  write_five();
  remove_checkpoint(path_);
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(CheckpointTest, ASecondProcessKeepsNothing) {
  Checkpoint first(options_, "key");
  store(first, 0);
  Checkpoint second(options_, "key");
  EXPECT_FALSE(has(second, 0));
  store(second, 1);
  store(first, 2);
  EXPECT_TRUE(has(first, 0) && !has(first, 1) && has(first, 2));
}

TEST_F(CheckpointTest, WithoutAFolderTheWorkGoesOn) {
  Checkpoint checkpoint({folder_ / "missing/out.partial", 0.0}, "key");
  store(checkpoint, 0);
  EXPECT_FALSE(has(checkpoint, 0));
}

TEST_F(CheckpointTest, SurvivesAKillAndAFullDisk) {
  const auto run = [&](const auto& body) {
    const pid_t child = fork();
    if (child == 0) {
      Checkpoint checkpoint(options_, "key");
      body(checkpoint);
      _exit(0);
    }
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    return status;
  };
  int status = run([&](Checkpoint& checkpoint) {
    store(checkpoint, 0);
    store(checkpoint, 1);
    raise(SIGKILL);
  });
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(found(), (std::vector<bool>{true, true, false, false, false}));
  status = run([&](Checkpoint& checkpoint) {
    const rlimit limit{1500, 1500};
    setrlimit(RLIMIT_FSIZE, &limit);
    for (std::uint32_t i = 2; i < 5; ++i) store(checkpoint, i);
  });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_TRUE(fs::is_empty(folder_.path()));  // leaves room for the output
}

}  // namespace
}  // namespace prt
