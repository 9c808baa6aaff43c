// prt-compress: clustered PCA of a transfer signal, into the glTF file that it belongs to.
#include <map>
#include <optional>
#include <string>

#include "cli/checkpoint.h"
#include "cli/paths.h"
#include "cli/tool.h"
#include "compress/job.h"
#include "compress/summary.h"
#include "core/log.h"
#include "linalg/product.h"

namespace {

using namespace prt;
using Job = compress::Job;

const std::map<std::string, std::optional<cpca::WeightFormat>> kWeights = {
    {"auto", std::nullopt},
    {"float", cpca::WeightFormat::float32},
    {"half", cpca::WeightFormat::float16},
    {"unorm16", cpca::WeightFormat::unorm16},
    {"unorm8", cpca::WeightFormat::unorm8}};

/// Returns the option of a signal without a model.
cli::Option* add_files(cli::Options& app, Job& job) {
  app.add_option("model", job.model, "The model that was baked (.glb, .gltf)");
  app.add_option("transfer", job.transfer, "Its transfer (.transfer.exr)");
  app.add_option("-o,--output", job.output,
                 "The model with compressed transfer (.glb), or of a signal the arrays (.npz)");
  return app.add_option("--signal", job.signal,
                        "In place of a model and its transfer: a matrix of float32 or float64, a "
                        "point a row (.npy)");
}

void add_method(cli::Options& app, Job& job) {
  app.start_group("Compression");
  app.add_option("--method", job.method,
                 "iterative: clusters by approximation error; adaptive: with more vectors where "
                 "they save most; static: by distance to the mean; vq: no vectors; pca: one "
                 "cluster")
      ->check(cli::IsMember({"iterative", "adaptive", "static", "vq", "pca"}));
  app.add_option("--clusters", job.cluster_count, "Clusters, at most one a vertex [256]")
      ->check(cli::Range(1, 1 << 20));
  app.add_option("--components", job.component_count,
                 "PCA vectors of each cluster; adaptive: on average over points [8]")
      ->check(cli::Range(0, 8192));
  app.add_option("--max-components", job.max_component_count,
                 "Adaptive: PCA vectors of a cluster; 0: twice --components")
      ->check(cli::Range(0, 8192));
  app.add_option("--iterations", job.iterations,
                 "Iterations, at most; iterative: for each number of vectors [20]")
      ->check(cli::Range(1, 10000));
  app.add_text(
         "--point-weights", [&](const std::string& name) { job.weigh_by_area = name == "area"; },
         "Weights of vertices in errors: none, or the area around them [none]")
      ->check(cli::IsMember({"none", "area"}));
  app.add_option("--coefficient-weights", job.coefficient_weights,
                 "Weights of the coefficients' squares, all above 0 (.npy)");
}

void add_bounds(cli::Options& app, cpca::Bound& bound) {
  app.start_group("Automatic choice of clusters and components");
  auto* const max_error =
      app.add_option("--max-error", bound.max_error, "The smallest result of this relative error");
  app.add_text(
         "--norm",
         [&](const std::string& name) {
           bound.norm = name == "max" ? cpca::Norm::maximum : cpca::Norm::rmse;
         },
         "Of all vertices (rmse), or of the worst (max) [rmse]")
      ->check(cli::IsMember({"rmse", "max"}))
      ->needs(max_error);
  app.add_option("--max-bytes", bound.max_bytes, "The best result in so many bytes, as stored")
      ->excludes(max_error);
}

void add_storage(cli::Options& app, cli::Option* signal, cpca::StorageOptions& options) {
  app.start_group("Coherence and storage");
  auto* const incoherent = app.add_flag("--no-coherence", options.is_incoherent,
                                        "Leave clusters as they are, without superclusters")
                               ->excludes(signal);
  app.add_option("--error-budget", options.coherence.error_budget,
                 "Squared error that reclassification may add, as a share of what there is")
      ->check(cli::Range(0.0, 1e6))
      ->excludes(incoherent)
      ->excludes(signal);
  app.add_option("--registers", options.coherence.register_budget,
                 "vec4 constants of the clusters that are drawn at a time")
      ->check(cli::Range(1, 65536))
      ->excludes(incoherent)
      ->excludes(signal);
  app.add_text(
         "--weights", [&](const std::string& name) { options.weights = kWeights.at(name); },
         "How weights are stored; auto: as small as adds under 1% to the squared error [auto]")
      ->check(cli::IsMember(kWeights))
      ->excludes(signal);
}

}  // namespace

int main(int argc, char** argv) {
  cli::Tool tool("prt-compress", "Compresses precomputed transfer by clustered PCA.",
                 "prt-compress a.glb a.transfer.exr -o a.prt.glb --clusters 256 --components 8");
  Job job;
  cli::Option* const signal = add_files(tool.options(), job);
  add_method(tool.options(), job);
  add_bounds(tool.options(), job.bound);
  add_storage(tool.options(), signal, job.storage);
  tool.add_seed();
  tool.add_component("BLAS", linalg::blas_description);
  return tool.run(argc, argv, [&](Report& report) {
    job.seed = tool.common().seed;
    job.no_clobber = tool.common().no_clobber;
    compress::check(job);
    if (!job.output.empty()) job.checkpoint = cli::checkpoint_beside(job.output);
    cli::check_paths({job.model, job.transfer, job.signal, job.coefficient_weights},
                     {{job.output, {job.signal.empty() ? ".glb" : ".npz"}, job.model}},
                     tool.common());
    compress::run(job, report);
    log::info("{}", compress::summary(report.json(), job.bound.norm));
  });
}
