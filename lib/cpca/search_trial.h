// Encodings that a search tries, and what it says of them.
#pragma once

#include <cstddef>
#include <span>

#include "cpca/search_choice.h"

namespace prt::cpca {

/// An encoding that was made on the way.
struct Trial {
  Choice choice;
  int first_cluster_count = 0;  ///< before it was tightened
  double error = 0.0;           ///< relative, by the norm of the bound
  std::size_t bytes = 0;        ///< by the cost of the bound
  bool is_warm = false;         ///< started from the one before
  double seconds = 0.0;         ///< of whichever run made it
  double flops = 0.0;           ///< as Encoded::flops
  bool is_resumed = false;      ///< made by an interrupted run
};

void log_trial(const Trial& trial);

/// Throws the Error (failed) of a search whose trials, at least one, are all beyond max_error.
[[noreturn]] void reject(const Bound& bound, std::span<const Trial> trials);

}  // namespace prt::cpca
