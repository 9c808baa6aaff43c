// Progress of long loops on standard error: share done, rate, time left. Threads may call advance.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>

namespace prt {

/// Shown only when standard error is a terminal, unless forced; never when quiet.
void set_progress_policy(bool forced, bool quiet);

class Progress {
 public:
  /// `unit` names what is counted ("rays"); total in units.
  Progress(std::string label, std::size_t total, std::string unit);
  ~Progress();
  void advance(std::size_t done);

 private:
  void draw(std::size_t done, bool last);

  std::string label_, unit_;
  std::size_t total_;
  std::atomic<std::size_t> done_{0};
  std::chrono::steady_clock::time_point start_, last_draw_;
  std::mutex mutex_;
  bool shown_;
};

}  // namespace prt
