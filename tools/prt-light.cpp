// prt-light: an environment map, or analytic lights, as spherical harmonics. See
// docs/tools/prt-light.md.
#include <map>
#include <optional>
#include <span>

#include "cli/paths.h"
#include "cli/tool.h"
#include "core/error.h"
#include "image/environment.h"
#include "sh/analytic_light.h"
#include "sh/basis.h"
#include "sh/light_edit.h"
#include "sh/projection.h"
#include "sh/window_report.h"

namespace {

using namespace prt;
using sh::AnalyticKind;

struct Options {
  std::filesystem::path input, output;
  int band_count = 5;
  std::size_t max_pixels = image::kMaxPixels;
  std::map<AnalyticKind, std::vector<float>> analytic;
  std::vector<float> rotation{0, 0, 0};
  sh::LightEdit edit;
  sh::Window window = sh::Window::none;
};

sh::Light map_light(const Options& options, Report& report) {
  std::optional<StageTimer> timer(std::in_place, report, "read");
  const image::Image map = image::read_environment(options.input, options.max_pixels);
  timer.emplace(report, "project");
  sh::Light light =
      sh::project_environment(options.band_count, map.width, map.height, map.pixels.data());
  timer.reset();
  light.source = options.input.filename().string();
  const auto energy = sh::environment_energy(map.width, map.height, map.pixels.data());
  const double total = energy[0] + energy[1] + energy[2];
  report.add_input(options.input);
  report.json()["map"] = {
      {"width", map.width},
      {"height", map.height},
      {"energy", total},
      {"energy_kept", total > 0 ? sh::statistics_of(light).energy / total : 1.0}};
  return light;
}

void run(const Options& options, const cli::CommonOptions& common, Report& report) {
  sh::Light light(options.band_count);
  for (const auto& [kind, numbers] : options.analytic) {
    const auto count = static_cast<std::size_t>(number_count(kind));
    for (std::size_t first = 0; first < numbers.size(); first += count) {
      const auto one = std::span(numbers).subspan(first, count);
      light = sum(light, analytic_light(kind, options.band_count, one));
    }
  }
  if (light.source.empty() && options.input.empty()) {
    throw Error(ErrorKind::usage, "no light",
                {.advice = "Give a map, --constant, --disk or --directional; see --help."});
  }
  cli::check_paths({options.input}, {{options.output, {".json"}, {}}}, common);
  if (!options.input.empty()) light = sum(map_light(options, report), light);
  const sh::WindowedLight windowed = sh::windowed(edited(light, options.edit), options.window);
  light = windowed.light;
  sh::write_light(options.output, light, common.no_clobber);
  const sh::LightStatistics statistics = sh::statistics_of(light);
  report.json()["band_count"] = light.band_count;
  report.json()["energy"] = statistics.energy;
  report.json()["band_energy"] = statistics.band_energy;
  report.json()["minimum_luminance"] = statistics.minimum_luminance;
  report.json()["maximum_luminance"] = statistics.maximum_luminance;
  report.json()["negative_fraction"] = statistics.negative_fraction;
  sh::report_window(windowed, report);
  report.add_output(options.output);
}

void add_options(cli::Options& app, Options& options) {
  app.add_option("input", options.input, "Latitude-longitude map: .exr .hdr .png .jpg");
  app.add_option("-o,--output", options.output, "Light file, .json")->required();
  app.add_option("--bands", options.band_count, "Bands of spherical harmonics")
      ->check(cli::Range(1, sh::kMaxBandCount));
  app.add_option("--max-pixels", options.max_pixels, "Pixels allowed in the map");
  const auto add_light = [&](const char* name, AnalyticKind kind, const char* shape,
                             const char* help) {
    app.add_option(name, options.analytic[kind], help)
        ->repeated_numbers(number_count(kind))
        ->type_name(shape)
        ->default_str("")
        ->group("Lights");
  };
  add_light("--constant", AnalyticKind::constant, "R,G,B", "Radiance from everywhere");
  add_light("--disk", AnalyticKind::disk, "X,Y,Z,RADIUS,R,G,B",
            "Direction to it, angular radius (degrees), radiance");
  add_light("--directional", AnalyticKind::directional, "X,Y,Z,R,G,B",
            "Direction to it, irradiance on a facing surface");

  const cli::Validator degrees = cli::Range(-36000.0, 36000.0);
  cli::Option* rotate = app.add_option("--rotate", options.rotation,
                                       "Turns the light about +X, then +Y, then +Z (degrees)");
  rotate->numbers(3)->type_name("X,Y,Z")->check(degrees)->group("Changes");
  app.add_option("--rotate-y", options.rotation[1], "Turns the light about +Y (degrees)")
      ->excludes(rotate)
      ->check(degrees)
      ->group("Changes");
  app.add_option("--exposure", options.edit.exposure, "Radiance times 2^EXPOSURE (stops)")
      ->check(cli::Range(-64.0, 64.0))
      ->group("Changes");
  app.add_choice("--window", options.window, sh::kWindows,
                 "Damps higher bands against ringing; auto: as little as does [none]")
      ->group("Changes");
}

}  // namespace

int main(int argc, char** argv) {
  cli::Tool tool("prt-light",
                 "Projects an environment map, or analytic lights, to spherical harmonics. All "
                 "lights given are added; the sum is turned, exposed and windowed.",
                 "prt-light sky.exr -o sky.json --bands 5 --rotate-y 90");
  Options options;
  add_options(tool.options(), options);
  return tool.run(argc, argv, [&](Report& report) {
    options.edit.rotation = Vec3(options.rotation[0], options.rotation[1], options.rotation[2]);
    run(options, tool.common(), report);
  });
}
