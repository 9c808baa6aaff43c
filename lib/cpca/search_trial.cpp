#include "cpca/search_trial.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/log.h"

namespace prt::cpca {

void log_trial(const Trial& trial) {
  log::info("{} clusters, {} components{}: relative error {:.4g}, {} bytes, {:.2f} s{}",
            trial.choice.cluster_count, trial.choice.component_count,
            trial.is_warm ? " from the last" : "", trial.error, trial.bytes, trial.seconds,
            trial.is_resumed ? " of an interrupted run" : "");
}

void reject(const Bound& bound, std::span<const Trial> trials) {
  const auto least =
      std::min_element(trials.begin(), trials.end(),
                       [](const Trial& a, const Trial& b) { return a.error < b.error; });
  throw_failed("no encoding found within the error",
               {.found = fmt::format("a relative error of {:.4g}", least->error),
                .expected = fmt::format("at most {:.4g}", *bound.max_error)});
}

}  // namespace prt::cpca
