// What a search says of its trials.
#pragma once

#include <span>

#include "cpca/search.h"

namespace prt::cpca {

void log_trial(const Trial& trial);

/// Throws the Error (failed) of a search whose trials, at least one, are all beyond the bound.
[[noreturn]] void reject(const Bound& bound, std::span<const Trial> trials);

}  // namespace prt::cpca
