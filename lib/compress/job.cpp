#include "compress/job.h"

#include <fmt/format.h>

#include <algorithm>

#include "compress/arrays.h"
#include "compress/encode.h"
#include "compress/input.h"
#include "compress/scaling.h"
#include "core/error.h"
#include "core/log.h"
#include "cpca/report.h"
#include "linalg/product.h"

namespace prt::compress {

namespace {

/// The storage of [Sloan03] §4.1, m_p n' + m_c (n' + 1) n: storage_bytes but for the indices.
std::size_t stored_numbers(const cpca::Encoding& encoding) {
  const std::size_t index_bytes = encoding.cluster_count <= 65536 ? 2 : 4;
  return (cpca::storage_bytes(encoding) - encoding.point_count * index_bytes) / sizeof(float);
}

/// What `component_count`, that of the cluster with most, does not say of adaptive encodings.
void report_components(const cpca::Encoding& encoding, nlohmann::ordered_json& json) {
  int least = encoding.component_count;
  for (int k = 0; k < encoding.cluster_count; ++k)
    least = std::min(least, encoding.component_count_of(k));
  double weight_count = 0;
  for (const std::uint32_t k : encoding.cluster_of_point)
    weight_count += encoding.component_count_of(static_cast<int>(k));
  json["least_component_count"] = least;
  json["mean_component_count"] = weight_count / static_cast<double>(encoding.point_count);
}

/// As the file stores it: what the encoder tells is of plain floats.
void set_bytes(std::size_t bytes, nlohmann::ordered_json& json) {
  json["bytes"] = bytes;
  json["compression_ratio"] = json["signal_bytes"].get<double>() / static_cast<double>(bytes);
}

/// Figures of what is stored, weighted ones too where there are weights. Throws Error (failed) when
/// these are beyond max_error, as rounding may make those that are near that of floats.
void report_encoding(const Job& job, const Input& input, const cpca::Encoded& encoded,
                     Report& report) {
  const StageTimer timer(report, "errors");
  std::vector<cpca::Group> groups;
  for (const auto& block : input.transfer.blocks) {
    groups.push_back({block.name, block.vertex_count});
  }
  auto& json = report.json();
  json.update(cpca::to_json(encoded, input.transfer.values, groups));
  report_components(encoded.encoding, json);
  json["blas"] = linalg::blas_description();
  const Errors errors = measure(encoded.encoding, input.transfer.values, input.weights());
  const Errors plain{.squared = json["squared_error"],
                     .energy = json["signal_energy"],
                     .largest = json["max_point_error"],
                     .point_count = encoded.encoding.point_count};
  json["relative_max"] = plain.relative_max();
  json["stored_numbers"] = stored_numbers(encoded.encoding);
  if (!input.document) {
    set_bytes(cost_in_arrays(encoded.encoding.cluster_count).bytes(encoded.encoding), json);
  }
  if (!input.weights().empty()) {
    json["weighted_squared_error"] = errors.squared;
    json["weighted_signal_energy"] = errors.energy;
    json["weighted_relative_rmse"] = errors.relative_rmse();
    json["weighted_max_point_error"] = errors.largest;
    json["weighted_relative_max"] = errors.relative_max();
  }
  if (!job.bound.max_error) return;
  const double found =
      job.bound.norm == cpca::Norm::rmse ? errors.relative_rmse() : errors.relative_max();
  if (found > *job.bound.max_error) {
    throw_failed("the error is beyond the bound as floats hold it",
                 {.found = fmt::format("a relative error of {:.6g}", found),
                  .expected = fmt::format("at most {:.6g}", *job.bound.max_error),
                  .advice = "Allow some more."});
  }
}

void save_model(const Job& job, Input& input, const cpca::Storage& storage, cpca::Encoding encoding,
                Report& report) {
  const signal::TransferSignal& signal = input.transfer;
  const gltf::PrecomputedTransfer transfer{.band_count = signal.band_count,
                                           .row_count = signal.row_count,
                                           .channel_count = signal.channel_count,
                                           .brdf = signal.brdf,
                                           .mesh_hash = signal.mesh_hash,
                                           .encoding = std::move(encoding),
                                           .weight_format = storage.weight_format,
                                           .first_clusters = storage.first_clusters};
  const std::size_t bytes = gltf::stored_bytes(transfer).total();
  set_bytes(bytes, report.json());
  if (job.bound.max_bytes && bytes > *job.bound.max_bytes) {
    throw_failed("the file takes more room than the search allowed for",
                 {.found = fmt::format("{} bytes", bytes),
                  .expected = fmt::format("at most {}", *job.bound.max_bytes),
                  .advice = "Add --no-coherence, or allow some more."});
  }
  input.document->set_precomputed_transfer(transfer);
  input.document->save_glb(job.output, job.no_clobber);
}

/// Numbers of the report that were measured in other units: squared errors of the scaled signal.
void rescale(double square, cpca::Encoded& encoded, cpca::Storage& storage) {
  for (cpca::Level& level : encoded.levels) {
    for (double& error : level.errors) error *= square;
  }
  if (!storage.coherence) return;
  storage.coherence->initial_error *= square;
  storage.coherence->final_error *= square;
}

void warn_of_size(const Job& job, const nlohmann::ordered_json& json) {
  if (json["compression_ratio"].get<double>() >= 1.0) return;
  const char* const advice = job.bound.max_error ? "Within a larger --max-error it may be smaller"
                                                 : "Ask for fewer clusters or components";
  log::warning("the result is larger than the signal: {} bytes, which were {}. {}",
               json["bytes"].get<std::size_t>(), json["signal_bytes"].get<std::size_t>(), advice);
}

}  // namespace

void run(const Job& job, Report& report) {
  check(job);
  Input input = load(job, report);
  std::vector<float>& values = input.transfer.values;
  if (input.metric) input.metric->apply(values);
  const Scaling scaling(values, input.coefficient_weights);
  scaling.apply(values);
  Result result = encode(job, input, report);
  cpca::Encoded& encoded = result.encoded;
  for (const cpca::Stage& stage : encoded.stages) report.add_stage(stage.name, stage.seconds);
  cpca::Storage storage;
  if (input.document) storage = store(job, input, result, report);
  scaling.undo(values);
  scaling.undo(storage.weight_format, encoded.encoding);
  if (input.metric) {
    for (const std::span<float> rows :
         {std::span(values), std::span(encoded.encoding.means), std::span(encoded.encoding.bases)})
      input.metric->undo(rows);
  }
  rescale(scaling.square(), encoded, storage);
  report_encoding(job, input, encoded, report);
  if (input.document) report.json()["weights"] = cpca::name_of(storage.weight_format);
  if (storage.coherence) {
    report.json().update(cpca::to_json(*storage.coherence, job.storage.coherence));
  } else if (input.document) {
    report.json().update(cpca::overdraw_to_json(input.scene.indices(), encoded.encoding));
  }
  if (!job.output.empty()) {
    values = std::vector<float>();  // room for what is written
    const StageTimer timer(report, "save");
    if (input.document) {
      save_model(job, input, storage, std::move(encoded.encoding), report);
    } else {
      save_arrays(job.output, encoded.encoding, job.no_clobber);
    }
    report.add_output(job.output);
    remove_checkpoint(job.checkpoint.path);
  }
  warn_of_size(job, report.json());
}

}  // namespace prt::compress
