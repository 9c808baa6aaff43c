// How fast rays are answered, by processor time.
#pragma once

#include <pmmintrin.h>

#include <cstddef>
#include <ctime>
#include <functional>
#include <numeric>
#include <vector>

#include "core/parallel.h"

namespace prt::bench {

/// Processor time of all threads of this process: other programs do not disturb it as they do the
/// clock on the wall.
inline double cpu_seconds() {
  timespec time;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Million rays a second, by processor time and the number of threads, of one pass over all
/// rays, and what it counted as blocked.
struct Rate {
  double mrays = 0.0;
  std::size_t blocked = 0;
};

inline Rate measure(std::size_t count, std::size_t task_size,
                    const std::function<std::size_t(std::size_t begin, std::size_t end)>& trace) {
  std::vector<std::size_t> blocked(block_count(count, task_size));
  const double start = cpu_seconds();
  parallel_for(count, task_size, [&](std::size_t begin, std::size_t end) {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    blocked[begin / task_size] = trace(begin, end);
  });
  const double seconds = (cpu_seconds() - start) / thread_count();
  return {static_cast<double>(count) / seconds * 1e-6,
          std::accumulate(blocked.begin(), blocked.end(), std::size_t{0})};
}

}  // namespace prt::bench
