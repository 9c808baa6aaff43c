#include <fmt/format.h>

#include "compress/job.h"
#include "core/error.h"

namespace prt::compress {

namespace {

void reject(const std::string& what, const std::string& advice) {
  throw Error(ErrorKind::usage, what, {.advice = advice});
}

}  // namespace

void check(const Job& job) {
  const bool has_model = !job.model.empty() || !job.transfer.empty();
  if (job.signal.empty()) {
    if (job.model.empty() || job.transfer.empty() || job.output.empty()) {
      reject("a model, its transfer and -o are needed", "Or a signal alone: --signal FILE.npy.");
    }
  } else if (has_model || !job.output.empty()) {
    reject("--signal goes without a model, a transfer and -o", "Its result is the report.");
  } else if (job.weigh_by_area) {
    reject("--point-weights area needs a model", "");
  }
  if (job.method == "vq" && job.component_count.value_or(0) != 0) {
    reject("--method vq has no components", "Leave --components out, or take --method static.");
  }
  if (job.method == "pca" && job.cluster_count.value_or(1) != 1) {
    reject("--method pca has one cluster", "Leave --clusters out, or take --method static.");
  }
  if (job.method == "pca" && job.iterations) reject("--method pca has no iterations", "");
  if (job.max_component_count > 0 && job.method != "adaptive") {
    reject("--max-components is for --method adaptive", "");
  }
  const bool is_bounded = job.bound.max_error || job.bound.max_bytes;
  if (is_bounded && (job.cluster_count || job.component_count)) {
    reject("--max-error and --max-bytes choose clusters and components",
           "Leave --clusters and --components out.");
  }
  if (is_bounded && (job.method == "vq" || job.method == "pca")) {
    reject(fmt::format("--method {} leaves nothing to choose within a bound", job.method),
           "Take static, iterative or adaptive.");
  }
}

}  // namespace prt::compress
