// Jobs that cannot be meant, told before the work.
#include <gtest/gtest.h>

#include "compress/job.h"
#include "core/error.h"

namespace prt::compress {
namespace {

/// Of the error of a job, that the user asked for what cannot be.
template <class Change>
std::string message(Change change) {
  Job job;
  job.model = "a.glb";
  job.transfer = "a.transfer.exr";
  job.output = "b.glb";
  change(job);
  try {
    check(job);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    return error.what();
  }
  return "no error";
}

TEST(CheckJob, RefusesBoundsThatNoSignalKeepsTo) {
  EXPECT_EQ(message([](Job& job) { job.bound.max_bytes = 0; }),
            "--max-bytes has to be above 0. No encoding takes no bytes.");
  EXPECT_EQ(message([](Job& job) { job.bound.max_bytes = 1; }), "no error");
  for (const double max_error : {0.0, -0.1}) {
    EXPECT_EQ(message([&](Job& job) { job.bound.max_error = max_error; }),
              "--max-error has to be above 0. 0.01 is one percent.");
  }
}

TEST(CheckJob, RefusesWhatAModelHasNoRoomForBeforeTheWork) {
  EXPECT_EQ(message([](Job&) {}), "no error");
  EXPECT_EQ(message([](Job& job) { job.cluster_count = 65537; }),
            "--clusters beyond what a model has room for: found 65537, expected at most 65536");
  EXPECT_EQ(message([](Job& job) { job.component_count = 257; }),
            "--components beyond what a model has room for: found 257, expected at most 256");
  EXPECT_EQ(message([](Job& job) {
              job.method = "adaptive";
              job.max_component_count = 300;
            }),
            "--max-components beyond what a model has room for: found 300, expected at most 256");
}

}  // namespace
}  // namespace prt::compress
