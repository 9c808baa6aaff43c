#include "core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cassert>
#include <memory>

namespace prt {

namespace {
std::unique_ptr<tbb::global_control> control;
int requested_count = 0;
}  // namespace

void set_thread_count(int count) {
  assert(count >= 0);
  requested_count = count;
  control.reset();
  if (count > 0) {
    control = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                    static_cast<std::size_t>(count));
  }
}

int thread_count() {
  const int most = tbb::this_task_arena::max_concurrency();
  return requested_count > 0 ? std::min(requested_count, most) : most;
}

void parallel_for(std::size_t count, std::size_t block,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  assert(block > 0);
  tbb::parallel_for(
      std::size_t{0}, block_count(count, block),
      [&](std::size_t i) { body(i * block, std::min(count, (i + 1) * block)); },
      tbb::simple_partitioner{});
}

}  // namespace prt
