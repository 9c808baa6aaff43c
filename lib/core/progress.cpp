#include "core/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace prt {

namespace {

bool policy_forced = false;
bool policy_quiet = false;

constexpr std::chrono::milliseconds kRedraw{200};

std::string with_prefix(double value) {
  for (const char* prefix : {"", "k", "M", "G"}) {
    if (value < 1000.0) return fmt::format("{:.3g}{}", value, prefix);
    value /= 1000.0;
  }
  return fmt::format("{:.3g}T", value);
}

}  // namespace

void set_progress_policy(bool forced, bool quiet) {
  policy_forced = forced;
  policy_quiet = quiet;
}

Progress::Progress(std::string label, std::size_t total, std::string unit)
    : label_(std::move(label)),
      unit_(std::move(unit)),
      total_(total),
      start_(std::chrono::steady_clock::now()),
      last_draw_(start_),
      shown_(!policy_quiet && (policy_forced || isatty(STDERR_FILENO) == 1)) {}

Progress::~Progress() {
  if (shown_) draw(done_.load(), true);
}

void Progress::advance(std::size_t done) {
  const std::size_t total_done = done_.fetch_add(done) + done;
  if (!shown_) return;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_draw_ < kRedraw) return;
  last_draw_ = now;
  draw(total_done, false);
}

void Progress::draw(std::size_t done, bool last) {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  const double rate = static_cast<double>(done) / std::max(elapsed.count(), 1e-9);
  const double share = total_ ? static_cast<double>(done) / static_cast<double>(total_) : 1.0;
  std::string line = fmt::format("\r{}: {:3.0f}%  {} {}/s", label_, 100.0 * std::min(share, 1.0),
                                 with_prefix(rate), unit_);
  if (last) {
    line += fmt::format("  {:.1f} s      \n", elapsed.count());
  } else if (rate > 0.0) {
    line += fmt::format("  {:.0f} s left ",
                        static_cast<double>(total_ - std::min(done, total_)) / rate);
  }
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace prt
