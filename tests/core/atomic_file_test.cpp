#include "core/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "core/file.h"
#include "temporary_folder.h"

namespace prt {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public testing::Test {
 protected:
  std::size_t entry_count() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
  }

  const TemporaryFolder folder_;
};

TEST_F(AtomicFileTest, AppearsOnlyOnCommit) {
  const fs::path path = folder_ / "a.txt";
  {
    AtomicFile file(path);
    file.write("hello");
    EXPECT_FALSE(fs::exists(path));
    EXPECT_EQ(file.temporary_path().extension(), ".txt");
    file.commit();
  }
  EXPECT_EQ(read_text_file(path), "hello");
  EXPECT_EQ(entry_count(), 1u);
}

TEST_F(AtomicFileTest, AbandonedWriteKeepsTheEarlierOutput) {
  const fs::path path = folder_ / "a.txt";
  std::ofstream(path) << "old";
  { AtomicFile(path).write("half"); }
  EXPECT_EQ(read_text_file(path), "old");
  EXPECT_EQ(entry_count(), 1u);
}

TEST_F(AtomicFileTest, NoClobberRefusesAnExistingFile) {
  const fs::path path = folder_ / "a.txt";
  std::ofstream(path) << "old";
  EXPECT_THROW(AtomicFile(path, true), Error);
  AtomicFile late(folder_ / "b.txt", true);
  late.write("mine");
  std::ofstream(folder_ / "b.txt") << "theirs";  // appears while we write
  EXPECT_THROW(late.commit(), Error);
  EXPECT_EQ(read_text_file(folder_ / "b.txt"), "theirs");
}

/// What is said of a place that nothing can be written in.
template <class Check>
std::string message(Check check) {
  try {
    check();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::failed);
    return error.what();
  }
  return "no error";
}

TEST_F(AtomicFileTest, APlaceThatCannotBeWrittenIsNamedWithTheReason) {
  const fs::path missing = folder_ / "missing";
  EXPECT_EQ(message([&] { AtomicFile(missing / "a.txt"); }),
            (missing / "a.txt").string() + ": nothing can be written in " + missing.string() +
                ": No such file or directory. Create " + missing.string() + " first.");
  for (const auto& check : {+[] { check_output("/dev/null/a.txt", false); },
                            +[] { check_output_folder("/dev/null/a.txt"); },
                            +[] { check_output_folder("/dev/null/a.txt/"); }}) {
    EXPECT_EQ(message(check),
              "/dev/null/a.txt: nothing can be written in /dev/null: Not a directory");
  }
  folder_.write("file", "");
  EXPECT_EQ(message([&] { check_output_folder(folder_ / "file"); }),
            (folder_ / "file").string() +
                ": exists and is no folder. Name a folder, or one that is to be made.");
  EXPECT_EQ(message([&] { check_output_folder(folder_ / "new"); }), "no error");
}

TEST_F(AtomicFileTest, SignalRemovesTheTemporaryFile) {
  const fs::path path = folder_ / "a.txt";
  std::ofstream(path) << "old";
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE}) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      AtomicFile file(path);
      file.write("half");
      raise(signal);
      _exit(0);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal);
    EXPECT_EQ(entry_count(), 1u);
    EXPECT_EQ(read_text_file(path), "old");
  }
}

TEST_F(AtomicFileTest, FullDiskIsAnErrorAndLeavesNothing) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const rlimit limit{4096, 4096};
    setrlimit(RLIMIT_FSIZE, &limit);
    int result = 1;
    try {
      AtomicFile file(folder_ / "a.txt");
      file.write(std::string(10000, 'x'));
    } catch (const Error& error) {
      result = error.exit_status() == 1 ? 0 : 2;
    }
    _exit(result);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(entry_count(), 0u);
}

}  // namespace
}  // namespace prt
