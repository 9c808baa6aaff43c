#include "core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace prt {
namespace {

TEST(ParallelFor, VisitsEveryElementOnceInBlocksThatDoNotDependOnThreads) {
  for (const int threads : {1, 2, 0}) {
    set_thread_count(threads);
    std::vector<std::atomic<int>> visits(1003);
    std::vector<std::size_t> ends(block_count(visits.size(), 100));
    parallel_for(visits.size(), 100, [&](std::size_t begin, std::size_t end) {
      ends[begin / 100] = end;
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    for (const auto& count : visits) EXPECT_EQ(count, 1);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) EXPECT_EQ(ends[i], 100 * (i + 1));
    EXPECT_EQ(ends.back(), visits.size());
  }
  set_thread_count(0);
}

TEST(ParallelFor, NothingToDoCallsNothing) {
  parallel_for(0, 16, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(ParallelFor, ExceptionOfTheBodyReachesTheCaller) {
  EXPECT_THROW(
      parallel_for(100, 10, [](std::size_t, std::size_t) { throw std::runtime_error("x"); }),
      std::runtime_error);
}

TEST(ThreadCount, FollowsTheSetting) {
  set_thread_count(1);
  EXPECT_EQ(thread_count(), 1);
  set_thread_count(0);
  const int all = thread_count();
  EXPECT_GE(all, 1);
  set_thread_count(all + 62);
  EXPECT_EQ(thread_count(), all) << "there are no more";
  set_thread_count(0);
}

}  // namespace
}  // namespace prt
