// prt-view: the interactive viewer. The work is in runtime/viewer.h.
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cli/paths.h"
#include "cli/tool.h"
#include "runtime/viewer.h"
#include "sh/window_report.h"
#include "tools/light_options.h"
#include "tools/near_light_options.h"

namespace {

using prt::runtime::Draw;
using prt::runtime::Show;
using prt::runtime::ViewerOptions;

/// Names of what the window shows first; the panel has the same.
const std::map<std::string, std::pair<Draw, Show>> kModes = {
    {"single", {Draw::single, Show::radiance}},
    {"clusters", {Draw::clusters, Show::radiance}},
    {"uncompressed", {Draw::uncompressed, Show::radiance}},
    {"cluster-colors", {Draw::single, Show::clusters}},
    {"supercluster-colors", {Draw::single, Show::superclusters}},
    {"error", {Draw::single, Show::error}}};

void add_options(prt::cli::Options& app, ViewerOptions& options) {
  const prt::cli::Option* const model =
      app.add_option("model", options.model, "A model of prt-compress (.glb); none: drop one");
  app.add_option("--transfer", options.transfer, "Its uncompressed transfer, to compare")
      ->needs(model);
  prt::add_light(app, options.light, options.band_count, options.window);
  app.add_text(
         "--mode",
         [&](const std::string& mode) { std::tie(options.draw, options.show) = kModes.at(mode); },
         "What to show first [single]")
      ->check(prt::cli::IsMember(kModes));
  app.add_option("--exposure", options.exposure, "Stops");
  app.add_option("--fov", options.vertical_fov, "Vertical field of view, degrees")
      ->check(prt::cli::Range(1.0, 170.0));
  app.add_flag("--animate", options.animate, "Turn the light as time goes by");
  prt::add_near_lights(app, options.near_lights, options.grid_size);
  app.start_group("Screenshot");
  const prt::cli::Option* const screenshot =
      app.add_option("--screenshot", options.screenshot, "Write the window to a .png and end");
  app.add_option("--frames", options.screenshot_frame_count, "Frames drawn before the screenshot")
      ->check(prt::cli::Range(1, 100000))
      ->needs(screenshot);
}

}  // namespace

int main(int argc, char** argv) {
  prt::cli::Tool tool("prt-view",
                      "Shows a baked model in a window. Drag to orbit, drag with the right button "
                      "to turn the light, drop models and lights on it.",
                      "prt-view bunny.prt.glb --light sunset.json");
  ViewerOptions options;
  add_options(tool.options(), options);
  return tool.run(argc, argv, [&](prt::Report& report) {
    const std::vector<std::filesystem::path> inputs{options.model, options.transfer, options.light};
    prt::cli::check_paths(inputs, {{options.screenshot, {".png"}, {}}}, tool.common());
    options.no_clobber = tool.common().no_clobber;
    options.debug = tool.common().verbose;
    prt::runtime::Viewer viewer(options);
    report.json()["start_seconds"] = viewer.run();
    prt::sh::report_window(viewer.light_window(), report);
    if (tool.common().report.empty()) return;  // files may have gone since they were opened
    for (const auto& input : inputs) {
      if (!input.empty()) report.add_input(input);
    }
    if (!options.screenshot.empty()) report.add_output(options.screenshot);
  });
}
