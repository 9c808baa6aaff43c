// Times the stages of an encoder, one after the other.
#pragma once

#include <string>
#include <vector>

#include "core/stopwatch.h"
#include "cpca/encoder.h"

namespace prt::cpca {

class StageClock {
 public:
  explicit StageClock(std::vector<Stage>& stages) : stages_(stages) {}

  /// What ran since the last call, or since the clock was made, was `name`.
  void finish(const std::string& name) {
    stages_.push_back({name, watch_.seconds()});
    watch_ = {};
  }

 private:
  std::vector<Stage>& stages_;
  Stopwatch watch_;
};

}  // namespace prt::cpca
