#include "compress/job.h"

#include <fmt/format.h>

#include <unistd.h>

#include <cmath>

#include "compress/signal.h"
#include "core/error.h"
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
  std::vector<float> scales, point_weights;
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
    input.scales =
        read_coefficient_scales(job.coefficient_weights, input.dimension, signal_bytes_limit());
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
          .bytes_per_cluster = 2 * sizeof(std::uint16_t)};
}

/// What reclassification and small weights may add to the error must fit below the bound as well.
cpca::Bound bound_of_encoder(const Job& job) {
  constexpr double kWeightShare = 0.01;
  cpca::Bound bound = job.bound;
  if (job.output.empty()) return bound;
  bound.cost = cost_in_file(job);
  if (!bound.max_error) return bound;
  const double budget = job.storage.is_incoherent ? 0.0 : job.storage.coherence.error_budget;
  *bound.max_error /= std::sqrt((1.0 + budget) * (1.0 + kWeightShare));
  return bound;
}

cpca::Encoded encode(const Job& job, const Input& input) {
  auto* const encoder = job.method == "adaptive"    ? cpca::encode_adaptive
                        : job.method == "iterative" ? cpca::encode_iterative
                                                    : cpca::encode_static;
  const cpca::Options options = make_options(job, input);
  const auto dimension = static_cast<int>(input.dimension);
  if (!job.bound.max_error && !job.bound.max_bytes) {
    return encoder(input.transfer.values, dimension, options);
  }
  return cpca::encode_within(bound_of_encoder(job), encoder, input.transfer.values, dimension,
                             options);
}

void report_encoding(const cpca::Encoded& encoded, const Input& input, Report& report) {
  const StageTimer timer(report, "errors");
  std::vector<cpca::Group> groups;
  for (const auto& block : input.transfer.blocks) {
    groups.push_back({block.name, block.vertex_count});
  }
  report.json().update(cpca::to_json(encoded, input.transfer.values, groups));
  report.json()["blas"] = linalg::blas_description();
}

void save(const Job& job, Input& input, const cpca::Storage& storage, cpca::Encoding encoding,
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
  auto& json = report.json();
  const std::size_t bytes = gltf::stored_bytes(transfer).total();  // the encoder's was an estimate
  json["bytes"] = bytes;
  json["compression_ratio"] = json["signal_bytes"].get<double>() / static_cast<double>(bytes);
  if (job.bound.max_bytes && bytes > *job.bound.max_bytes) {
    throw_failed("the weights take more room than the search allowed for",
                 {.found = fmt::format("{} bytes", bytes),
                  .expected = fmt::format("at most {}", *job.bound.max_bytes),
                  .advice = "Add --weights unorm16 --no-coherence, or allow some more."});
  }
  const StageTimer timer(report, "save");
  input.document->set_precomputed_transfer(transfer);
  input.document->save_glb(job.output, job.no_clobber);
  report.add_output(job.output);
}

}  // namespace

void run(const Job& job, Report& report) {
  check(job);
  Input input = load(job, report);
  std::vector<float>& values = input.transfer.values;
  if (!input.scales.empty()) scale_rows(input.scales, values);
  cpca::Encoded encoded = encode(job, input);
  for (const cpca::Stage& stage : encoded.stages) report.add_stage(stage.name, stage.seconds);
  cpca::Storage storage;
  if (input.document) {
    storage = cpca::prepare_storage(values, input.scene.indices(), input.transfer.row_count,
                                    job.storage, encoded.encoding, report);
  }
  if (!input.scales.empty()) {
    unscale_rows(input.scales, values);
    unscale_rows(input.scales, encoded.encoding.means);
    unscale_rows(input.scales, encoded.encoding.bases);
  }
  report_encoding(encoded, input, report);
  if (input.document) save(job, input, storage, std::move(encoded.encoding), report);
  const auto& json = report.json();
  if (json["compression_ratio"].get<double>() < 1.0) {
    log::warning(
        "the result is larger than the signal: {} bytes, which were {}. Ask for fewer "
        "clusters or components",
        json["bytes"].get<std::size_t>(), json["signal_bytes"].get<std::size_t>());
  }
}

}  // namespace prt::compress
