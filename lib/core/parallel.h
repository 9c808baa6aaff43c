// Parallel loops over fixed blocks. Block limits depend on count and block size alone, never on the
// number of threads, so a caller that writes each block's result to its own place and adds up in
// block order gets the same bytes for any number of threads (of one instruction set, core/cpu.h).
#pragma once

#include <cstddef>
#include <functional>

namespace prt {

/// Threads that parallel_for uses from now on, at most all processors of this process; 0: these.
void set_thread_count(int count);
int thread_count();  ///< that it really uses

/// Calls body(begin, end) for the blocks [0, block), [block, 2 block), … of [0, count), on several
/// threads, in no particular order. An exception thrown by body leaves through here.
void parallel_for(std::size_t count, std::size_t block,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Number of blocks that parallel_for makes.
inline std::size_t block_count(std::size_t count, std::size_t block) {
  return (count + block - 1) / block;
}

}  // namespace prt
