// prt-transfer: per-vertex transfer of a model, diffuse or glossy (docs/tools/prt-transfer.md).
#include <map>
#include <optional>

#include "cli/checkpoint.h"
#include "cli/paths.h"
#include "cli/tool.h"
#include "core/error.h"
#include "core/exit_rows.h"
#include "core/file.h"
#include "core/log.h"
#include "gltf/document.h"
#include "linalg/product.h"
#include "ray/engine.h"
#include "transfer/bake.h"
#include "transfer/figures.h"

namespace {

using namespace prt;
struct Options {
  std::filesystem::path input, output;
  transfer::DiffuseOptions diffuse;
  bool unshadowed = false;
  std::string mode = "diffuse";
  std::optional<std::string> brdf;
  std::optional<int> row_count;
  std::optional<std::string> projection;
};

void add_options(cli::Options& app, Options& options) {
  app.add_option("input", options.input, "Model (.glb, .gltf)")->required();
  app.add_option("-o,--output", options.output, "Transfer file (.transfer.exr)")->required();
  cli::Option* const bands =
      app.add_option("--bands", options.diffuse.band_count, "Bands of the light");
  bands->check(cli::Range(1, 16))->group("Transfer");
  cli::Option* const rays = app.add_option("--rays", options.diffuse.ray_count,
                                           "Shadow rays per vertex, over its hemisphere");
  rays->check(cli::Range(1, 1 << 17))->group("Transfer");
  cli::Option* const bounces =
      app.add_option("--bounces", options.diffuse.bounce_count, "Bounces of interreflection");
  bounces->check(cli::Range(0, 1000))->group("Transfer");
  app.add_option("--bounce-rays", options.diffuse.bounce_ray_count,
                 "Rays per vertex for what is reflected; 0: a quarter of --rays")
      ->check(cli::Range(0, 1 << 14))
      ->needs(bounces)
      ->group("Transfer");
  app.add_flag("--unshadowed", options.unshadowed, "No rays: the closed form of a convex body")
      ->excludes(bounces)
      ->excludes(rays)
      ->group("Transfer");
  const std::map<std::string, transfer::ChannelMode> modes = {
      {"auto", transfer::ChannelMode::automatic},
      {"1", transfer::ChannelMode::one},
      {"3", transfer::ChannelMode::three}};
  app.add_choice("--channels", options.diffuse.channels, modes,
                 "Colour channels; auto: 3 where an albedo is coloured")
      ->default_str("auto")
      ->group("Transfer");
}

void add_matrix_options(cli::Options& app, Options& options) {
  const auto group = [](cli::Option* option) { return option->group("Glossy transfer"); };
  group(app.add_option("--mode", options.mode, "diffuse: a vector a vertex; matrix: glossy"))
      ->check(cli::IsMember({"diffuse", "matrix"}));
  group(app.add_option("--rows", options.row_count,
                       "Exit coefficients, n*n or, without l=1 m=0, n*n - 1; 25 if not given"))
      ->check(cli::Range(transfer::kMinMatrixRowCount, kMaxExitRowCount))
      ->check(cli::accepted_by([](const auto& n) { sh::hemisphere_functions(std::stoi(n)); }));
  group(app.add_option("--brdf", options.brdf,
                       std::string(brdf::kBrdfSyntax) + "; from-material if not given"))
      ->check(cli::accepted_by([](const auto& name) { brdf::parse_brdf(name); }));
  group(app.add_option("--projection", options.projection, "To compare with [least-squares]"))
      ->check(cli::IsMember({"least-squares", "zero-hemisphere"}));
}

void check_usage(const Options& options) {
  const auto reject = [](const char* what) { throw Error(ErrorKind::usage, what); };
  const bool matrix = options.mode == "matrix";
  if (!matrix && options.row_count) reject("--rows needs --mode matrix");
  if (!matrix && options.brdf) reject("--brdf needs --mode matrix");
  if (!matrix && options.projection) reject("--projection needs --mode matrix");
  const bool wide = options.diffuse.band_count > transfer::kMaxMatrixBandCount;
  if (matrix && wide) reject("--bands above 8 needs --mode diffuse");
}

mesh::Scene load_scene(const std::filesystem::path& path, bool is_glossy, Report& report) {
  const StageTimer timer(report, "load");
  report.add_input(path);
  const gltf::Document document = gltf::Document::load(path);
  mesh::Scene scene = document.scene();
  for (const std::string& feature : document.unbaked_features(scene, is_glossy))
    log::warning("{}: {}", path.string(), feature);
  return scene;
}

transfer::MatrixOptions matrix_options(const Options& options) {
  using Projection = sh::HemisphereProjection;
  const bool zero = options.projection == "zero-hemisphere";
  const transfer::DiffuseOptions& from = options.diffuse;
  return {.brdf = options.brdf.value_or("from-material"),
          .band_count = from.band_count,
          .row_count = options.row_count.value_or(25),
          .ray_count = from.ray_count,
          .bounce_count = from.bounce_count,
          .bounce_ray_count = from.bounce_ray_count,
          .shadowed = from.shadowed,
          .channels = from.channels,
          .seed = from.seed,
          .projection = zero ? Projection::zero_hemisphere : Projection::least_squares,
          .scratch_folder = from.scratch.folder,
          .checkpoint = from.checkpoint};
}

void bake(Options& options, const cli::CommonOptions& common, Report& report) {
  check_usage(options);
  cli::check_paths({options.input}, {{options.output, {".exr"}, {}}}, common);
  const bool is_glossy = options.mode == "matrix";
  const mesh::Scene scene = load_scene(options.input, is_glossy, report);
  options.diffuse.shadowed = !options.unshadowed;
  options.diffuse.seed = common.seed;
  options.diffuse.checkpoint = cli::checkpoint_beside(options.output);
  options.diffuse.scratch.folder = folder_of(options.output);
  transfer::DiffuseStats stats;
  const signal::TransferSignal signal =
      is_glossy ? transfer::bake_matrices(scene, matrix_options(options), options.output,
                                          common.no_clobber, stats, report)
                : transfer::bake_diffuse(scene, options.diffuse, options.output, common.no_clobber,
                                         stats, report);
  remove_checkpoint(options.diffuse.checkpoint.path);
  transfer::report_figures(report, stats, signal);
  report.add_output(options.output);
}

}  // namespace

int main(int argc, char** argv) {
  cli::Tool tool("prt-transfer",
                 "Computes how each vertex of a model turns distant light into exit radiance: "
                 "shadows and interreflection, as spherical harmonic transfer vectors or matrices.",
                 "prt-transfer bunny.glb -o bunny.transfer.exr --bands 5 --rays 2048 --bounces 2");
  Options options;
  add_options(tool.options(), options);
  add_matrix_options(tool.options(), options);
  tool.add_seed();
  tool.add_component("Embree", ray::embree_version);
  tool.add_component("BLAS", linalg::blas_description);
  return tool.run(argc, argv, [&](Report& report) { bake(options, tool.common(), report); });
}
