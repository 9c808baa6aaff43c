#include "compress/encode.h"

#include <fmt/format.h>

#include <algorithm>

#include "compress/format_search.h"
#include "core/checkpoint.h"
#include "core/hash.h"
#include "core/log.h"
#include "cpca/empty_clusters.h"
#include "cpca/fit.h"
#include "gltf/precomputed_transfer.h"

namespace prt::compress {

namespace {

cpca::Options make_options(const Job& job, const Input& input) {
  cpca::Options options;
  const auto point_count = static_cast<int>(input.transfer.values.size() / input.dimension);
  options.cluster_count = job.cluster_count.value_or(std::min(options.cluster_count, point_count));
  options.component_count = job.component_count.value_or(
      std::min(options.component_count, static_cast<int>(input.dimension)));
  if (job.method == "vq") options.component_count = 0;
  if (job.method == "pca") options.cluster_count = 1;
  options.max_component_count = job.max_component_count;
  if (input.document && 2 * options.component_count > gltf::kMaxComponentCount &&
      options.max_component_count == 0) {
    options.max_component_count = gltf::kMaxComponentCount;
  }
  options.iterations = job.iterations.value_or(options.iterations);
  options.seed = job.seed;
  options.point_weights = input.point_weights;
  return options;
}

/// All that decides the encoding, of a scaled signal.
std::string checkpoint_key(const Job& job, const Input& input, const cpca::Options& o) {
  Hasher signal, weights;
  signal.add(std::span<const float>(input.transfer.values));
  weights.add(std::span<const float>(input.point_weights));
  const auto number = [](const auto& n) { return n ? fmt::format("{}", *n) : "-"; };
  const cpca::Bound& bound = job.bound;
  const bool is_bounded = bound.max_error || bound.max_bytes;
  const std::string format = !is_bounded           ? "-"
                             : job.storage.weights ? cpca::name_of(*job.storage.weights)
                                                   : "auto";
  return fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", job.method, signal.hex(),
                     input.dimension, weights.hex(), o.cluster_count, o.component_count,
                     o.iterations, o.seed, o.max_component_count, number(bound.max_error),
                     number(bound.max_bytes), static_cast<int>(bound.norm),
                     input.scene.vertex_count(), format,
                     is_bounded ? reclassification_share(job) : 0.0);
}

}  // namespace

Result encode(const Job& job, const Input& input, Report& report) {
  cpca::Options options = make_options(job, input);
  Checkpoint checkpoint(job.checkpoint, checkpoint_key(job, input, options));
  options.checkpoint = &checkpoint;
  Result result;
  if (job.bound.max_error || job.bound.max_bytes) {
    result = search(job, input, options, report);
  } else {
    result = {.encoded = cpca::encode(method_of(job), input.transfer.values,
                                      static_cast<int>(input.dimension), options),
              .weights = job.storage.weights};
  }
  cpca::drop_empty_clusters(result.encoded.encoding);
  return result;
}

cpca::Storage store(const Job& job, const Input& input, Result& result, Report& report) {
  const std::vector<float>& signal = input.transfer.values;
  const cpca::Bound& bound = job.bound;
  cpca::Encoding& encoding = result.encoded.encoding;
  cpca::StorageOptions options = job.storage;
  options.weights = result.weights;
  options.limits.point_weights = input.point_weights;
  if (bound.max_error) {
    const double square = (1.0 - result.reserve) * *bound.max_error * *bound.max_error *
                          cpca::weighted_energy(signal, encoding.point_count, input.point_weights);
    if (bound.norm == cpca::Norm::rmse) {
      options.limits.total = square;
    } else {
      options.limits.point = square / static_cast<double>(encoding.point_count);
    }
  }
  const auto prepare = [&] {
    return cpca::prepare_storage(signal, input.scene.indices(), input.transfer.row_count, options,
                                 encoding, report);
  };
  if (options.is_incoherent || !(bound.max_error || bound.max_bytes)) return prepare();
  encoding.weights = std::vector<float>();
  const cpca::Encoding plain = encoding;  // without weights, which follow from the rest
  cpca::fit_weights(signal, encoding);
  cpca::Storage storage = prepare();
  // Moves stretch the ranges of weights, and give points of adaptive encodings more of them.
  const bool is_left_out = !is_within(job, *result.weights, encoding, input);
  report.json()["coherence_left_out"] = is_left_out;
  if (!is_left_out) return storage;
  log::info("coherence would leave the bound, and is left out");
  encoding = plain;
  cpca::fit_weights(signal, encoding);
  options.is_incoherent = true;
  return prepare();
}

}  // namespace prt::compress
