// Times the stages of an encoder, one after the other.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "cpca/encoder.h"

namespace prt::cpca {

class StageClock {
 public:
  explicit StageClock(std::vector<Stage>& stages) : stages_(stages) {}

  /// What ran since the last call, or since the clock was made, was `name`.
  void finish(const std::string& name) {
    const auto now = std::chrono::steady_clock::now();
    stages_.push_back({name, std::chrono::duration<double>(now - last_).count()});
    last_ = now;
  }

 private:
  std::vector<Stage>& stages_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace prt::cpca
