#include "compress/job.h"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "compress/arrays.h"
#include "compress/scaling.h"
#include "compress/signal.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/log.h"
#include "cpca/report.h"
#include "gltf/document.h"
#include "linalg/product.h"
#include "signal/npy.h"
#include "signal/transfer_signal.h"

namespace prt::compress {

namespace {

struct Input {
  std::optional<gltf::Document> document;
  mesh::Scene scene;                ///< without a document empty
  signal::TransferSignal transfer;  ///< of a plain signal only the values
  std::size_t dimension = 0;
  std::vector<float> coefficient_weights, point_weights;
  std::optional<sh::RadianceMetric> metric;  ///< of matrices, unless coefficients have weights

  Weights weights() const {
    return {point_weights, coefficient_weights, metric ? &*metric : nullptr};
  }
};

/// What a signal may take: beside it encoders need half as much again.
std::size_t signal_bytes_limit() {
  const auto pages = static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES));
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) / 3 * 2;
}

Input load(const Job& job, Report& report) {
  const StageTimer timer(report, "load");
  Input input;
  if (job.signal.empty()) {
    input.document = gltf::Document::load(job.model);
    input.scene = input.document->scene();
    input.transfer = signal::read_transfer(job.transfer, signal_bytes_limit());
    signal::check_belongs_to(input.transfer, input.scene, job.transfer);
    input.dimension = static_cast<std::size_t>(input.transfer.dimension());
  } else {
    signal::Matrix matrix = signal::read_npy(job.signal, signal_bytes_limit());
    input.transfer.values = std::move(matrix.values);
    input.dimension = matrix.column_count;
  }
  if (!job.coefficient_weights.empty()) {
    input.coefficient_weights =
        read_coefficient_weights(job.coefficient_weights, input.dimension, signal_bytes_limit());
  } else if (input.transfer.row_count > 1) {
    const auto bands = static_cast<std::size_t>(input.transfer.band_count);
    input.metric.emplace(input.transfer.row_count, bands * bands);
  }
  if (job.weigh_by_area) input.point_weights = vertex_areas(input.scene);
  // Only now, as it reads the files: those that are too large are refused before.
  for (const auto& path : {job.model, job.transfer, job.signal, job.coefficient_weights}) {
    if (!path.empty()) report.add_input(path);
  }
  return input;
}

cpca::Options make_options(const Job& job, const Input& input) {
  cpca::Options options;
  options.cluster_count = job.cluster_count.value_or(options.cluster_count);
  options.component_count = job.component_count.value_or(options.component_count);
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

/// As gltf::stored_bytes counts; weights are as small as choose_weights nearly always makes them.
cpca::StorageCost cost_in_file(const Job& job) {
  const cpca::WeightFormat format = job.storage.weights.value_or(cpca::WeightFormat::unorm16);
  return {.bytes_per_point = 4,
          .bytes_per_weight = cpca::bytes_of(format),
          .weight_group = job.method == "adaptive" ? 1u : 4u,
          .bytes_per_cluster = 2 * sizeof(std::uint16_t),
          .max_component_count = gltf::kMaxComponentCount};
}

/// What reclassification and small weights may add to the error must fit below the bound as well.
/// Of the largest error of a point reclassification takes only what is left.
cpca::Bound bound_of_encoder(const Job& job) {
  cpca::Bound bound = job.bound;
  bound.cost = job.signal.empty() ? cost_in_file(job) : cost_in_arrays();
  if (job.max_component_count > 0) bound.cost.max_component_count = job.max_component_count;
  if (!bound.max_error || !job.signal.empty()) return bound;
  const bool spends = !job.storage.is_incoherent && bound.norm == cpca::Norm::rmse;
  const double budget = spends ? job.storage.coherence.error_budget : 0.0;
  *bound.max_error /= std::sqrt((1.0 + budget) * (1.0 + cpca::kMaxAddedError));
  return bound;
}

nlohmann::ordered_json to_json(const cpca::Found& found) {
  auto trials = nlohmann::ordered_json::array();
  for (const cpca::Trial& trial : found.trials) {
    trials.push_back({{"cluster_count", trial.choice.cluster_count},
                      {"component_count", trial.choice.component_count},
                      {"relative_error", trial.error},
                      {"bytes", trial.bytes},
                      {"warm", trial.is_warm},
                      {"resumed", trial.is_resumed},
                      {"seconds", trial.seconds}});
  }
  return {{"sampled_points", found.sampled_count},
          {"seconds", found.seconds},
          {"flops_cost", found.flops_cost},
          {"trials", trials}};
}

/// All that decides the encoding, of a scaled signal.
std::string checkpoint_key(const Job& job, const Input& input, const cpca::Options& o,
                           const cpca::Bound& bound) {
  Hasher signal, weights;
  signal.add(std::span<const float>(input.transfer.values));
  weights.add(std::span<const float>(input.point_weights));
  const auto number = [](const auto& n) { return n ? fmt::format("{}", *n) : "-"; };
  return fmt::format(
      "{} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", job.method, signal.hex(),
      input.dimension, weights.hex(), o.cluster_count, o.component_count, o.iterations, o.seed,
      o.max_component_count, number(bound.max_error), number(bound.max_bytes),
      static_cast<int>(bound.norm), bound.cost.bytes_per_point, bound.cost.bytes_per_weight,
      bound.cost.weight_group, bound.cost.bytes_per_cluster, bound.cost.max_component_count);
}

cpca::Encoded encode(const Job& job, const Input& input, Report& report) {
  const cpca::Method method = job.method == "adaptive"    ? cpca::Method::adaptive
                              : job.method == "iterative" ? cpca::Method::iterative
                                                          : cpca::Method::fixed;
  cpca::Options options = make_options(job, input);
  const cpca::Bound bound = bound_of_encoder(job);
  Checkpoint checkpoint(job.checkpoint, checkpoint_key(job, input, options, bound));
  options.checkpoint = &checkpoint;
  const auto dimension = static_cast<int>(input.dimension);
  if (!job.bound.max_error && !job.bound.max_bytes) {
    return cpca::encode(method, input.transfer.values, dimension, options);
  }
  cpca::Found found = cpca::encode_within(bound, method, input.transfer.values, dimension, options);
  log::info("the search took as long as {:.2f} encodings", found.cost);
  report.json()["search_cost"] = found.cost;
  report.json()["search"] = to_json(found);
  return std::move(found.encoded);
}

/// Reclassifies and rounds weights of a scaled signal's encoding within the bound of the job.
cpca::Storage prepare_storage(const Job& job, const Input& input, cpca::Encoding& encoding,
                              Report& report) {
  cpca::StorageOptions options = job.storage;
  options.limits.point_weights = input.point_weights;
  if (job.bound.max_error) {
    const double square =
        *job.bound.max_error * *job.bound.max_error *
        cpca::weighted_energy(input.transfer.values, encoding.point_count, input.point_weights);
    if (job.bound.norm == cpca::Norm::rmse) {
      options.limits.total = square;
    } else {
      options.limits.point = square / static_cast<double>(encoding.point_count);
    }
  }
  return cpca::prepare_storage(input.transfer.values, input.scene.indices(),
                               input.transfer.row_count, options, encoding, report);
}

/// The storage of [Sloan03] §4.1, m_p n' + m_c (n' + 1) n: storage_bytes but for the indices.
std::size_t stored_numbers(const cpca::Encoding& encoding) {
  const std::size_t index_bytes = encoding.cluster_count <= 65536 ? 2 : 4;
  return (cpca::storage_bytes(encoding) - encoding.point_count * index_bytes) / sizeof(float);
}

/// As the file stores it: what the encoder tells is of plain floats.
void set_bytes(std::size_t bytes, nlohmann::ordered_json& json) {
  json["bytes"] = bytes;
  json["compression_ratio"] = json["signal_bytes"].get<double>() / static_cast<double>(bytes);
}

/// Figures of what is stored, weighted ones too where there are weights. Throws Error (failed) when
/// these are beyond max_error: the search left room, which given weights may exceed.
void report_encoding(const Job& job, const Input& input, const cpca::Encoded& encoded,
                     Report& report) {
  const StageTimer timer(report, "errors");
  std::vector<cpca::Group> groups;
  for (const auto& block : input.transfer.blocks) {
    groups.push_back({block.name, block.vertex_count});
  }
  auto& json = report.json();
  json.update(cpca::to_json(encoded, input.transfer.values, groups));
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
    throw_failed("weights as small as --weights asks for are not within --max-error",
                 {.found = fmt::format("a relative error of {:.6g}", found),
                  .expected = fmt::format("at most {:.6g}", *job.bound.max_error),
                  .advice = "Take --weights auto."});
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
    throw_failed("the weights take more room than the search allowed for",
                 {.found = fmt::format("{} bytes", bytes),
                  .expected = fmt::format("at most {}", *job.bound.max_bytes),
                  .advice = "Add --weights unorm16 --no-coherence, or allow some more."});
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

void warn_of_size(const nlohmann::ordered_json& json) {
  if (json["compression_ratio"].get<double>() >= 1.0) return;
  log::warning(
      "the result is larger than the signal: {} bytes, which were {}. Ask for fewer clusters or "
      "components",
      json["bytes"].get<std::size_t>(), json["signal_bytes"].get<std::size_t>());
}

}  // namespace

void run(const Job& job, Report& report) {
  check(job);
  Input input = load(job, report);
  std::vector<float>& values = input.transfer.values;
  if (input.metric) input.metric->apply(values);
  const Scaling scaling(values, input.coefficient_weights);
  scaling.apply(values);
  cpca::Encoded encoded = encode(job, input, report);
  for (const cpca::Stage& stage : encoded.stages) report.add_stage(stage.name, stage.seconds);
  cpca::Storage storage;
  if (input.document) storage = prepare_storage(job, input, encoded.encoding, report);
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
    const StageTimer timer(report, "save");
    if (input.document) {
      save_model(job, input, storage, std::move(encoded.encoding), report);
    } else {
      save_arrays(job.output, encoded.encoding, job.no_clobber);
    }
    report.add_output(job.output);
    remove_checkpoint(job.checkpoint.path);
  }
  warn_of_size(report.json());
}

}  // namespace prt::compress
