// prt-render: pictures without a window (runtime/render_job.h, runtime/reference/reference_job.h).
#include <map>
#include <string>

#include "brdf/brdf.h"
#include "cli/checkpoint.h"
#include "cli/paths.h"
#include "cli/tool.h"
#include "gl/context.h"
#include "ray/engine.h"
#include "runtime/reference/reference_job.h"
#include "runtime/render_job.h"
#include "tools/light_options.h"
#include "tools/near_light_options.h"

namespace {

using prt::runtime::Background;
using prt::runtime::Draw;
using prt::runtime::Passes;
using prt::runtime::PictureOptions;
using prt::runtime::Show;
using prt::runtime::ViewBasis;

const std::map<std::string, Draw> kDraws = {
    {"single", Draw::single}, {"clusters", Draw::clusters}, {"uncompressed", Draw::uncompressed}};
const std::map<std::string, prt::runtime::Sums> kSums = {
    {"kept", prt::runtime::Sums::kept}, {"every-frame", prt::runtime::Sums::every_frame}};
const std::map<std::string, Passes> kPasses = {
    {"auto", Passes::automatic}, {"one", Passes::one}, {"per-channel", Passes::per_channel}};
const std::map<std::string, ViewBasis> kViewBases = {{"polynomial", ViewBasis::polynomial},
                                                     {"map", ViewBasis::map}};
const std::map<std::string, Show> kShows = {{"radiance", Show::radiance},
                                            {"clusters", Show::clusters},
                                            {"superclusters", Show::superclusters},
                                            {"error", Show::error}};
const std::map<std::string, Background> kBackgrounds = {{"environment", Background::environment},
                                                        {"color", Background::color},
                                                        {"none", Background::none}};

void add_picture_options(prt::cli::Options& app, PictureOptions& options) {
  app.add_option("model", options.model, "The model, .glb or .gltf")->required();
  app.add_option("-o,--output", options.output, "The picture: .png, or .exr (linear, alpha)")
      ->required();

  app.start_group("Light");
  prt::add_light(app, options.light, options.band_count, options.window);
  app.add_option("--rotate-light", options.light_rotation,
                 "Turn the light about +Y, degrees, counter-clockwise from above");

  app.start_group("Camera");
  app.add_vector("--eye", options.eye, "Where the camera stands [frames the model]");
  app.add_vector("--target", options.target, "What it looks at [the model's middle]");
  app.add_vector("--up", options.up, "Up in the picture [0,1,0]");
  app.add_option("--fov", options.vertical_fov, "Vertical field of view, degrees")
      ->check(prt::cli::Range(0.01, 179.0));

  app.start_group("Picture");
  app.add_size("--size", options.width, options.height, "Width and height in pixels [1024x1024]");
  app.add_option("--exposure", options.exposure, "Stops, for .png");
  app.add_choice("--background", options.background, kBackgrounds,
                 "Behind the model [environment]");
  app.add_vector("--background-color", options.background_color, "Linear [0.1,0.1,0.1]");
}

void add_render_options(prt::cli::Options& app, prt::runtime::RenderOptions& options) {
  app.start_group("Real-time rendering");
  app.add_option("--transfer", options.transfer, "Uncompressed transfer of prt-transfer (.exr)");
  app.add_choice(
      "--draw", options.draw, kDraws,
      "How: compressed in one draw, by clusters, or uncompressed [single, or uncompressed "
      "with --transfer]");
  app.add_choice("--sums", options.sums, kSums,
                 "By light: when it changes, or in every frame as it is drawn [kept]");
  app.add_choice("--passes", options.exit.passes, kPasses,
                 "Of glossy transfer: all colours in one, or per-channel [auto: as OpenGL can]");
  app.add_choice("--view-basis", options.exit.view_basis, kViewBases,
                 "Of glossy transfer: evaluated, or from a map of the hemisphere [polynomial]");
  prt::add_near_lights(app, options.near_lights, options.grid_size);
  app.add_choice("--show", options.show, kShows, "What to show [radiance]");
  app.add_option("--antialias", options.sample_count,
                 "Samples in a pixel, at most what the driver has; 1: pixel centres")
      ->check(prt::cli::Range(1, 64));
}

void add_reference_options(prt::cli::Options& app, prt::runtime::ReferenceOptions& options,
                           bool& reference) {
  app.start_group("Reference");
  prt::cli::Option* const flag = app.add_flag(
      "--reference", reference, "Path trace instead: ground truth, no transfer needed");
  app.add_option("--brdf", options.brdf,
                 std::string(prt::brdf::kBrdfSyntax) +
                     "; the one that the transfer was baked with, else lambert, if not given")
      ->check(prt::cli::accepted_by([](const auto& name) { prt::brdf::parse_brdf(name); }))
      ->needs(flag);
  app.add_option("--samples", options.sample_count, "Paths in a pixel")
      ->check(prt::cli::Range(1, 1 << 20))
      ->needs(flag);
  app.add_option("--bounces", options.bounce_count, "Interreflections; 0: direct light only")
      ->check(prt::cli::Range(0, 64))
      ->needs(flag);
  app.add_text(
         "--light-mode", [&](const std::string& mode) { options.full_map = mode == "full"; },
         "Light of the bands, or the full environment map [band-limited]")
      ->check(prt::cli::IsMember({"band-limited", "full"}))
      ->needs(flag);
  app.add_option("--noise-output", options.noise,
                 "Write the standard error of each pixel too (.exr), for prt-inspect --noise")
      ->needs(flag);
  for (const char* name : {"--transfer", "--draw", "--sums", "--passes", "--view-basis", "--show",
                           "--point-light", "--sphere-light", "--light-grid"})
    flag->excludes(app.get(name));
}

}  // namespace

int main(int argc, char** argv) {
  prt::cli::Tool tool("prt-render", "Renders a baked model under a light, without a window.",
                      "prt-render bunny.prt.glb --light sunset.json -o bunny.png --size 1024x1024");
  prt::runtime::RenderOptions options;
  prt::runtime::ReferenceOptions reference_options;
  bool reference = false;
  add_picture_options(tool.options(), options.picture);
  add_render_options(tool.options(), options);
  add_reference_options(tool.options(), reference_options, reference);
  tool.add_seed()->needs(tool.options().get("--reference"));
  tool.add_component("Embree", prt::ray::embree_version);
  tool.add_component("OpenGL", [] {
    const prt::gl::HeadlessContext context;
    return prt::gl::description();
  });
  return tool.run(argc, argv, [&](prt::Report& report) {
    const PictureOptions& picture = options.picture;
    prt::cli::check_paths(
        {picture.model, picture.light, options.transfer},
        {{picture.output, {".png", ".exr"}, {}}, {reference_options.noise, {".exr"}, {}}},
        tool.common());
    options.picture.no_clobber = tool.common().no_clobber;
    options.debug = tool.common().verbose;
    if (!reference) return prt::runtime::render(options, report);
    reference_options.picture = options.picture;
    reference_options.box_filter = options.sample_count > 1;
    reference_options.seed = tool.common().seed;
    reference_options.checkpoint = prt::cli::checkpoint_beside(picture.output);
    prt::runtime::render_reference(reference_options, report);
  });
}
