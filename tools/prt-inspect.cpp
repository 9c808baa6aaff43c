// prt-inspect: what is in a file of prtkit's, is it valid, where is the error.
#include <fmt/format.h>

#include "cli/paths.h"
#include "cli/tool.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "inspect/compare.h"
#include "inspect/compression_error.h"
#include "inspect/hemisphere.h"
#include "inspect/inspection.h"
#include "inspect/plots.h"

namespace {

using namespace prt;
namespace fs = std::filesystem;

struct Options {
  fs::path file, transfer, plots;
  std::vector<fs::path> compare;  ///< image, reference
  inspect::ComparisonFiles comparison;
  bool json = false, hemisphere = false;
  bool is_beside = false;  ///< whether the transfer is to be that beside the file, if it is there
};

void add_options(cli::Options& app, Options& options) {
  app.add_option("FILE", options.file,
                 "Model (.glb, .gltf), transfer (.transfer.exr), light (.json) or image");
  app.add_flag("--json", options.json, "JSON instead of text");
  app.add_flag("--hemisphere", options.hemisphere, "No file: errors of hemispherical projections");
  app.add_option("--transfer", options.transfer,
                 "Transfer that FILE was compressed from: reports the error, vertex by vertex")
      ->group("Compression error");
  app.add_option("--plots", options.plots,
                 "Folder, made when missing, for pictures and tables of the clusters and, with "
                 "--transfer or NAME.transfer.exr beside FILE, of errors and other encodings")
      ->group("Compression error");
  app.add_option("--compare", options.compare, "Two images, the second being the reference")
      ->values(2)
      ->group("Comparison");
  app.add_option("--mask", options.comparison.mask, "Image: count only pixels above 0.5")
      ->group("Comparison");
  app.add_option("--noise", options.comparison.noise, "Standard error of the reference")
      ->group("Comparison");
  app.add_option("--heatmap", options.comparison.heatmap,
                 "Write a picture of the difference (.png, .exr)")
      ->group("Comparison");
  app.add_option("--heatmap-max", options.comparison.heatmap_max,
                 "Radiance at the red end of its scale; 0: the 99th percentile")
      ->check(cli::at_least_zero())
      ->group("Comparison");
}

void check_usage(const Options& options) {
  const auto reject = [](const char* what) { throw Error(ErrorKind::usage, what); };
  if (!options.file.empty() + !options.compare.empty() + options.hemisphere != 1) {
    reject("name one of FILE, --compare and --hemisphere");
  }
  if (!options.transfer.empty() && options.file.empty()) reject("--transfer needs FILE");
  if (!options.plots.empty() && options.file.empty()) reject("--plots needs FILE");
  const bool of_comparison = !options.comparison.mask.empty() ||
                             !options.comparison.noise.empty() ||
                             !options.comparison.heatmap.empty();
  if (of_comparison && options.compare.empty()) {
    reject("--mask, --noise and --heatmap need --compare");
  }
  if (options.comparison.heatmap_max > 0.0 && options.comparison.heatmap.empty()) {
    reject("--heatmap-max needs --heatmap");
  }
}

void check_files(Options& options, const cli::CommonOptions& common) {
  std::vector<cli::Output> outputs{{options.comparison.heatmap, {".png", ".exr"}, {}}};
  if (!options.plots.empty()) {
    options.is_beside = options.transfer.empty();
    if (options.is_beside) options.transfer = inspect::transfer_beside(options.file);
    check_output_folder(options.plots);
    for (const fs::path& file : inspect::plot_files(options.plots, !options.transfer.empty())) {
      outputs.push_back({file, {file.extension().string()}, {}});
    }
  }
  std::vector<fs::path> inputs{options.file, options.transfer, options.comparison.mask,
                               options.comparison.noise};
  inputs.insert(inputs.end(), options.compare.begin(), options.compare.end());
  cli::check_paths(inputs, outputs, common);
}

bool inspect_one(const Options& options, bool no_clobber, Report& report, inspect::Json& json) {
  {
    const StageTimer timer(report, "inspect");
    report.add_input(options.file);
    const inspect::Inspection inspection = inspect::inspect_file(options.file);
    json = inspection.json;
    if (!inspection.valid()) return false;
  }
  if (options.plots.empty() && options.transfer.empty()) return true;
  inspect::check_compressed(json);
  if (options.is_beside) inspect::tell_transfer_beside(options.file);
  if (!options.plots.empty()) {
    const StageTimer timer(report, "plots");
    write_plots(inspect::plots_of_model(options.file), options.plots, no_clobber, report);
  }
  if (options.transfer.empty()) return true;
  const StageTimer timer(report, "compression error");
  report.add_input(options.transfer);
  json["compression_error"] = inspect::compression_error(options.file, options.transfer).json;
  if (!options.plots.empty()) {
    write_plots(inspect::plots_of_compression(options.file, options.transfer), options.plots,
                no_clobber, report);
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  cli::Tool tool("prt-inspect", "Shows what is in a file, checks it, and measures errors.",
                 "prt-inspect bunny.prt.glb --transfer bunny.transfer.exr --plots .\n"
                 "  prt-inspect --compare bunny.exr reference.exr --heatmap difference.png");
  add_options(tool.options(), options);
  bool valid = true;
  const int status = tool.run(argc, argv, [&](Report& report) {
    check_usage(options);
    check_files(options, tool.common());
    const bool no_clobber = tool.common().no_clobber;
    inspect::Json json = inspect::Json::object();
    if (options.hemisphere) json["hemisphere"] = inspect::hemisphere_table();
    if (!options.file.empty()) valid = inspect_one(options, no_clobber, report, json);
    if (!options.compare.empty()) {
      options.comparison.image = options.compare[0];
      options.comparison.reference = options.compare[1];
      inspect::compare_files(options.comparison, no_clobber, report, json);
    }
    fmt::print("{}\n", options.json ? json_text(json, 2) : inspect::to_text(json));
    report.json()["result"] = json;
  });
  if (status != 0 || valid) return status;
  // A finding is a result, which the report has: said when that is written.
  fmt::print(stderr, "prt-inspect: {}: the file is not valid. The findings say what is wrong.\n",
             options.file.string());
  return static_cast<int>(ErrorKind::bad_input);
}
