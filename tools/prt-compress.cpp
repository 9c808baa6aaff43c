// prt-compress: clustered PCA of a transfer signal, into the glTF file that it belongs to.
#include <fmt/format.h>

#include <map>
#include <optional>
#include <string>

#include "cli/paths.h"
#include "cli/tool.h"
#include "core/log.h"
#include "cpca/encoder.h"
#include "cpca/report.h"
#include "cpca/storage.h"
#include "gltf/document.h"
#include "linalg/product.h"
#include "signal/transfer_signal.h"

namespace {

using namespace prt;

struct Arguments {
  std::filesystem::path model, transfer, output;
  std::string method = "static";
  cpca::Options options;
  cpca::StorageOptions storage;
};

const std::map<std::string, std::optional<cpca::WeightFormat>> kWeights = {
    {"auto", std::nullopt},
    {"float", cpca::WeightFormat::float32},
    {"unorm16", cpca::WeightFormat::unorm16},
    {"unorm8", cpca::WeightFormat::unorm8}};

void add_options(CLI::App& app, Arguments& arguments) {
  cpca::Options& options = arguments.options;
  app.add_option("model", arguments.model, "The model that was baked (.glb, .gltf)")->required();
  app.add_option("transfer", arguments.transfer, "Its transfer (.transfer.exr)")->required();
  app.add_option("-o,--output", arguments.output, "The model with compressed transfer (.glb)")
      ->required();
  const char* group = "Compression";
  app.add_option("--clusters", options.cluster_count, "Clusters, at most one a vertex")
      ->check(CLI::Range(1, 1 << 20))
      ->group(group);
  app.add_option("--components", options.component_count, "PCA vectors of each cluster")
      ->check(CLI::Range(0, 8192))
      ->group(group);
  app.add_option(
         "--method", arguments.method,
         "iterative: clusters by approximation error; static: by distance to the mean; vq: no "
         "vectors; pca: one cluster")
      ->check(CLI::IsMember({"iterative", "static", "vq", "pca"}))
      ->group(group);
  app.add_option("--iterations", options.iterations,
                 "Iterations, at most; iterative: for each number of vectors")
      ->check(CLI::Range(1, 10000))
      ->group(group);
}

void add_storage_options(CLI::App& app, cpca::StorageOptions& options) {
  app.option_defaults()->group("Coherence and storage");
  auto* const incoherent = app.add_flag("--no-coherence", options.is_incoherent,
                                        "Leave clusters as they are, without superclusters");
  app.add_option("--error-budget", options.coherence.error_budget,
                 "Squared error that reclassification may add, as a share of what there is")
      ->check(CLI::Range(0.0, 1e6))
      ->excludes(incoherent);
  app.add_option("--registers", options.coherence.register_budget,
                 "vec4 constants of the clusters that are drawn at a time")
      ->check(CLI::Range(1, 65536))
      ->excludes(incoherent);
  app.add_option_function<std::string>(
         "--weights", [&](const std::string& name) { options.weights = kWeights.at(name); },
         "How weights are stored; auto: as small as adds under 1% to the squared error [auto]")
      ->check(CLI::IsMember(kWeights));
}

cpca::Encoded encode(const signal::TransferSignal& signal, const Arguments& arguments) {
  auto* const encoder =
      arguments.method == "iterative" ? cpca::encode_iterative : cpca::encode_static;
  return encoder(signal.values, signal.dimension(), arguments.options);
}

void report_encoding(const cpca::Encoded& encoded, const signal::TransferSignal& signal,
                     Report& report) {
  const StageTimer timer(report, "errors");
  std::vector<cpca::Group> groups;
  for (const auto& block : signal.blocks) groups.push_back({block.name, block.vertex_count});
  report.json().update(cpca::to_json(encoded, signal.values, groups));
  report.json()["blas"] = linalg::blas_description();
}

/// As stored, in place of the encoder's estimate.
void report_bytes(const gltf::PrecomputedTransfer& transfer, nlohmann::ordered_json& json) {
  const std::size_t bytes = gltf::stored_bytes(transfer).total();
  json["bytes"] = bytes;
  json["compression_ratio"] = json["signal_bytes"].get<double>() / static_cast<double>(bytes);
}

struct Input {
  gltf::Document document;
  signal::TransferSignal signal;
};

Input load(const Arguments& arguments, Report& report) {
  report.add_input(arguments.model);
  report.add_input(arguments.transfer);
  const StageTimer timer(report, "load");
  Input input{gltf::Document::load(arguments.model), signal::read_transfer(arguments.transfer)};
  signal::check_belongs_to(input.signal, input.document.scene(), arguments.transfer);
  return input;
}

void compress(Arguments arguments, const cli::CommonOptions& common, Report& report) {
  cpca::Options& options = arguments.options;
  options.seed = common.seed;
  if (arguments.method == "vq") options.component_count = 0;
  if (arguments.method == "pca") options.cluster_count = 1;
  cli::check_paths({arguments.model, arguments.transfer},
                   {{arguments.output, {".glb"}, arguments.model}}, common);
  Input input = load(arguments, report);
  const signal::TransferSignal& signal = input.signal;
  cpca::Encoded encoded = encode(signal, arguments);
  for (const cpca::Stage& stage : encoded.stages) report.add_stage(stage.name, stage.seconds);
  const cpca::Storage storage =
      cpca::prepare_storage(signal.values, input.document.scene().indices(), signal.row_count,
                            arguments.storage, encoded.encoding, report);
  report_encoding(encoded, signal, report);
  const gltf::PrecomputedTransfer transfer{.band_count = signal.band_count,
                                           .row_count = signal.row_count,
                                           .channel_count = signal.channel_count,
                                           .brdf = signal.brdf,
                                           .mesh_hash = signal.mesh_hash,
                                           .encoding = std::move(encoded.encoding),
                                           .weight_format = storage.weight_format,
                                           .first_clusters = storage.first_clusters};
  report_bytes(transfer, report.json());
  const StageTimer save(report, "save");
  input.document.set_precomputed_transfer(transfer);
  input.document.save_glb(arguments.output, common.no_clobber);
  report.add_output(arguments.output);
}

void log_summary(const nlohmann::ordered_json& json) {
  log::info(
      "{} points of {} coefficients in {} clusters of {} components: {:.3g} times smaller, "
      "relative error {:.3f}% (SE {:.6g})",
      json["point_count"].get<std::size_t>(), json["dimension"].get<int>(),
      json["cluster_count"].get<int>(), json["component_count"].get<int>(),
      json["compression_ratio"].get<double>(), 100.0 * json["relative_rmse"].get<double>(),
      json["squared_error"].get<double>());
}

}  // namespace

int main(int argc, char** argv) {
  cli::Tool tool("prt-compress", "Compresses precomputed transfer by clustered PCA.",
                 "prt-compress a.glb a.transfer.exr -o a.prt.glb --clusters 256 --components 8");
  Arguments arguments;
  add_options(tool.app(), arguments);
  add_storage_options(tool.app(), arguments.storage);
  tool.add_component("BLAS", linalg::blas_description);
  return tool.run(argc, argv, [&](Report& report) {
    compress(arguments, tool.common(), report);
    log_summary(report.json());
  });
}
