// prt-transfer: per-vertex diffuse transfer of a model (docs/tools/prt-transfer.md).

#include <map>

#include "cli/paths.h"
#include "cli/tool.h"
#include "core/log.h"
#include "gltf/document.h"
#include "linalg/product.h"
#include "ray/engine.h"
#include "signal/transfer_signal.h"
#include "transfer/diffuse.h"

namespace {

using namespace prt;

struct Options {
  std::filesystem::path input, output;
  transfer::DiffuseOptions diffuse;
  bool unshadowed = false;
};

void add_options(CLI::App& app, Options& options) {
  app.add_option("input", options.input, "Model (.glb, .gltf)")->required();
  app.add_option("-o,--output", options.output, "Transfer file (.transfer.exr)")->required();
  CLI::Option* const bands =
      app.add_option("--bands", options.diffuse.band_count, "Bands of the light");
  bands->check(CLI::Range(1, 16))->capture_default_str()->group("Transfer");
  CLI::Option* const rays = app.add_option("--rays", options.diffuse.ray_count,
                                           "Shadow rays per vertex, over its hemisphere");
  rays->check(CLI::Range(1, 1 << 17))->capture_default_str()->group("Transfer");
  CLI::Option* const bounces =
      app.add_option("--bounces", options.diffuse.bounce_count, "Bounces of interreflection");
  bounces->check(CLI::Range(0, 1000))->capture_default_str()->group("Transfer");
  app.add_option("--bounce-rays", options.diffuse.bounce_ray_count,
                 "Rays per vertex for what is reflected; 0: a quarter of --rays")
      ->check(CLI::Range(0, 1 << 14))
      ->needs(bounces)
      ->capture_default_str()
      ->group("Transfer");
  app.add_flag("--unshadowed", options.unshadowed, "No rays: the closed form of a convex body")
      ->excludes(bounces)
      ->group("Transfer");
  const std::map<std::string, transfer::ChannelMode> modes = {
      {"auto", transfer::ChannelMode::automatic},
      {"1", transfer::ChannelMode::one},
      {"3", transfer::ChannelMode::three}};
  app.add_option_function<std::string>(
         "--channels",
         [&options, modes](const std::string& name) { options.diffuse.channels = modes.at(name); },
         "Colour channels; auto: 3 where an albedo is coloured")
      ->check(CLI::IsMember({"auto", "1", "3"}))
      ->default_str("auto")
      ->group("Transfer");
}

void add_figures(Report& report, const transfer::DiffuseStats& stats,
                 const signal::TransferSignal& signal) {
  nlohmann::ordered_json& json = report.json();
  json["vertex_count"] = signal.vertex_count();
  json["channel_count"] = signal.channel_count;
  json["rays_cast"] = stats.rays_cast;
  json["rays_per_second"] = stats.rays_per_second;
  json["buried_vertex_count"] = stats.buried_vertex_count;
  json["unrepaired_vertex_count"] = stats.unrepaired_vertex_count;
  for (const transfer::DiffuseStats::Primitive& primitive : stats.primitives) {
    json["meshes"].push_back({{"name", primitive.name},
                              {"vertex_count", primitive.vertex_count},
                              {"triangle_count", primitive.triangle_count},
                              {"buried_vertex_count", primitive.buried_vertex_count}});
  }
  report.add_stage("build", stats.build_seconds);
  report.add_stage("trace", stats.trace_seconds);
  report.add_stage("bounce", stats.bounce_seconds);
}

mesh::Scene load_scene(const std::filesystem::path& path, Report& report) {
  const StageTimer timer(report, "load");
  report.add_input(path);
  return gltf::Document::load(path).scene();
}

void bake(const Options& options, const cli::CommonOptions& common, Report& report) {
  cli::check_paths({options.input}, {{options.output, {".exr"}, {}}}, common);
  const mesh::Scene scene = load_scene(options.input, report);
  transfer::DiffuseOptions diffuse = options.diffuse;
  diffuse.shadowed = !options.unshadowed;
  diffuse.seed = common.seed;
  transfer::DiffuseStats stats;
  const signal::TransferSignal signal = transfer::compute_diffuse(scene, diffuse, stats);
  add_figures(report, stats, signal);
  if (stats.buried_vertex_count > 0) {
    log::warning("{} of {} vertices are buried in other geometry; {} took their neighbours' values",
                 stats.buried_vertex_count, signal.vertex_count(),
                 stats.buried_vertex_count - stats.unrepaired_vertex_count);
  }
  {
    const StageTimer timer(report, "save");
    signal::write_transfer(options.output, signal, common.no_clobber);
  }
  report.add_output(options.output);
  log::info("{} vertices, {:.1f} million rays, {:.1f} million a second", signal.vertex_count(),
            1e-6 * static_cast<double>(stats.rays_cast), 1e-6 * stats.rays_per_second);
}

}  // namespace

int main(int argc, char** argv) {
  cli::Tool tool("prt-transfer",
                 "Computes how each vertex of a model turns distant light into exit radiance: "
                 "shadows and interreflection, as spherical harmonic transfer vectors.",
                 "prt-transfer bunny.glb -o bunny.transfer.exr --bands 5 --rays 2048 --bounces 2");
  Options options;
  add_options(tool.app(), options);
  tool.add_component("Embree", ray::embree_version);
  tool.add_component("BLAS", linalg::blas_description);
  return tool.run(argc, argv, [&](Report& report) { bake(options, tool.common(), report); });
}
