#include <fmt/format.h>

#include "compress/job.h"
#include "core/error.h"
#include "gltf/precomputed_transfer.h"

namespace prt::compress {

namespace {

void reject(const std::string& what, const std::string& advice) {
  throw Error(ErrorKind::usage, what, {.advice = advice});
}

void check_room(const char* option, int found, int most) {
  if (found <= most) return;
  throw Error(ErrorKind::usage, fmt::format("{} beyond what a model has room for", option),
              {.found = fmt::format("{}", found), .expected = fmt::format("at most {}", most)});
}

void check_files(const Job& job) {
  if (job.signal.empty()) {
    if (job.model.empty() || job.transfer.empty() || job.output.empty()) {
      reject("a model, its transfer and -o are needed", "Or a signal alone: --signal FILE.npy.");
    }
    if (job.model.extension() == ".exr") {
      reject(job.model.string() + " is no model", "Name the model first, then its transfer.");
    }
    check_room("--clusters", job.cluster_count.value_or(1), gltf::kMaxClusterCount);
    check_room("--components", job.component_count.value_or(0), gltf::kMaxComponentCount);
    check_room("--max-components", job.max_component_count, gltf::kMaxComponentCount);
  } else if (!job.model.empty() || !job.transfer.empty()) {
    reject("--signal goes without a model and a transfer", "Name the signal alone.");
  } else if (job.weigh_by_area) {
    reject("--point-weights area needs a model", "Leave it out.");
  }
}

}  // namespace

void check(const Job& job) {
  check_files(job);
  if (job.method == "vq" && job.component_count.value_or(0) != 0) {
    reject("--method vq has no components", "Leave --components out, or take --method static.");
  }
  if (job.method == "pca" && job.cluster_count.value_or(1) != 1) {
    reject("--method pca has one cluster", "Leave --clusters out, or take --method static.");
  }
  if (job.method == "pca" && job.iterations)
    reject("--method pca has no iterations", "Leave --iterations out.");
  if (job.max_component_count > 0 && job.method != "adaptive") {
    reject("--max-components is for --method adaptive", "Leave it out, or take that method.");
  }
  const bool is_bounded = job.bound.max_error || job.bound.max_bytes;
  const int average = job.component_count.value_or(cpca::Options().component_count);
  if (!is_bounded && job.max_component_count > 0 && average > job.max_component_count) {
    reject(fmt::format("--components {}, the average, is above --max-components", average),
           "Ask for fewer with --components.");
  }
  if (job.bound.max_error && !(*job.bound.max_error > 0.0)) {
    reject("--max-error has to be above 0", "0.01 is one percent.");
  }
  if (job.bound.max_error && job.bound.norm == cpca::Norm::rmse && *job.bound.max_error >= 1.0) {
    reject("--max-error of 1 or more is the error of no encoding at all", "0.01 is one percent.");
  }
  if (job.bound.max_bytes == 0u) {
    reject("--max-bytes has to be above 0", "No encoding takes no bytes.");
  }
  if (is_bounded && (job.cluster_count || job.component_count)) {
    reject("--max-error and --max-bytes choose clusters and components",
           "Leave --clusters and --components out.");
  }
  if (is_bounded && job.method == "pca") {
    reject("--max-error and --max-bytes are not for --method pca",
           "Take static, which chooses one cluster where that is best.");
  }
}

}  // namespace prt::compress
