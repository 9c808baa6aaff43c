// prt-compress: clustered PCA of a transfer signal, into the glTF file that it belongs to.
#include <fmt/format.h>

#include <string>

#include "cli/paths.h"
#include "cli/tool.h"
#include "core/log.h"
#include "cpca/encoder.h"
#include "cpca/figures.h"
#include "gltf/document.h"
#include "linalg/product.h"
#include "signal/transfer_signal.h"

namespace {

using namespace prt;

struct Arguments {
  std::filesystem::path model, transfer, output;
  std::string method = "static";
  cpca::Options options;
};

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
  app.add_option("--method", arguments.method,
                 "static: PCA in each cluster; vq: no vectors; pca: one cluster")
      ->check(CLI::IsMember({"static", "vq", "pca"}))
      ->group(group);
  app.add_option("--iterations", options.iterations, "Iterations of clustering, at most")
      ->check(CLI::Range(1, 10000))
      ->group(group);
}

nlohmann::ordered_json to_json(const cpca::Figures& figures) {
  return {{"squared_error", figures.squared_error},
          {"signal_energy", figures.signal_energy},
          {"relative_rmse", figures.relative_rmse()},
          {"max_point_error", figures.max_point_error}};
}

/// Figures in total, at the top level, and of each primitive under "meshes".
void report_errors(const signal::TransferSignal& signal, const cpca::Encoding& encoding,
                   nlohmann::ordered_json& json) {
  const std::vector<double> errors = cpca::point_errors(encoding, signal.values);
  const auto dimension = static_cast<std::size_t>(signal.dimension());
  json.update(to_json(cpca::summarize(errors, signal.values)));
  std::size_t first = 0;
  for (const auto& block : signal.blocks) {
    nlohmann::ordered_json entry{{"name", block.name}, {"vertex_count", block.vertex_count}};
    entry.update(to_json(cpca::summarize(
        std::span(errors).subspan(first, block.vertex_count),
        std::span(signal.values).subspan(first * dimension, block.vertex_count * dimension))));
    json["meshes"].push_back(std::move(entry));
    first += block.vertex_count;
  }
}

void report_encoding(const cpca::Encoded& encoded, nlohmann::ordered_json& json) {
  const cpca::Encoding& encoding = encoded.encoding;
  const auto signal_bytes =
      encoding.point_count * static_cast<std::size_t>(encoding.dimension) * sizeof(float);
  json["point_count"] = encoding.point_count;
  json["dimension"] = encoding.dimension;
  json["cluster_count"] = encoding.cluster_count;
  json["component_count"] = encoding.component_count;
  json["iterations"] = encoded.iterations;
  json["signal_bytes"] = signal_bytes;
  json["compressed_bytes"] = cpca::storage_bytes(encoding);
  json["compression_ratio"] =
      static_cast<double>(signal_bytes) / static_cast<double>(cpca::storage_bytes(encoding));
  json["blas"] = linalg::blas_description();
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
  cpca::Encoded encoded = cpca::encode_static(signal.values, signal.dimension(), options);
  for (const cpca::Stage& stage : encoded.stages) report.add_stage(stage.name, stage.seconds);
  report_encoding(encoded, report.json());
  {
    const StageTimer timer(report, "errors");
    report_errors(signal, encoded.encoding, report.json());
  }
  const StageTimer save(report, "save");
  input.document.set_precomputed_transfer({.band_count = signal.band_count,
                                           .row_count = signal.row_count,
                                           .channel_count = signal.channel_count,
                                           .brdf = signal.brdf,
                                           .mesh_hash = signal.mesh_hash,
                                           .encoding = std::move(encoded.encoding)});
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
  tool.add_component("BLAS", linalg::blas_description);
  return tool.run(argc, argv, [&](Report& report) {
    compress(arguments, tool.common(), report);
    log_summary(report.json());
  });
}
