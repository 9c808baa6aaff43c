#include "runtime/render_job.h"

#include <cmath>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "core/stopwatch.h"
#include "gl/context.h"
#include "runtime/light_inside.h"
#include "runtime/picture.h"
#include "sh/window_report.h"

namespace prt::runtime {

namespace {

constexpr int kDefaultBandCount = 5;

View make_view(const RenderOptions& options, const Model& model) {
  View view;
  view.camera = make_camera(options.picture, model.bounds);
  view.draw = options.draw.value_or(model.signal ? Draw::uncompressed : Draw::single);
  view.sums = options.sums.value_or(Sums::kept);
  view.show = options.show;
  view.background = make_background(options.picture, options.show);
  view.background_color = options.picture.background_color;
  view.exposure = options.picture.exposure;
  return view;
}

/// Near lights take the place of the usual lamp.
Lighting make_distant_lighting(const RenderOptions& options, const Model& model, Report& report) {
  const bool only_near = options.picture.light.empty() && !options.near_lights.empty();
  return only_near ? lighting_from(sh::Light(model.band_count()))
                   : make_lighting(options.picture, model.band_count(), report);
}

/// Turns the light, and reports how long all that follows from it takes.
void turn_light(Renderer& renderer, const View& view, float degrees, Report& report) {
  const Stopwatch stopwatch;
  renderer.set_light_rotation(light_rotation(degrees));
  renderer.prepare(view);
  gl::finish();
  report.json()["light_change_seconds"] = stopwatch.seconds();
}

}  // namespace

camera::Camera make_camera(const PictureOptions& options, const camera::Sphere& bounds) {
  const float aspect = static_cast<float>(options.width) / static_cast<float>(options.height);
  camera::Camera camera = camera::frame(bounds, options.vertical_fov, aspect);
  const Vec3 eye_from_target = camera.eye - camera.target;
  camera.target = options.target.value_or(camera.target);
  camera.eye = options.eye.value_or(camera.target + eye_from_target);
  camera.up = options.up;
  camera::check(camera);
  return camera;
}

void check_options(const PictureOptions& options) {
  check_exposure(options.exposure);
  if (!std::isfinite(options.light_rotation))
    throw Error(ErrorKind::usage, "--rotate-light is not a finite angle");
  if (!is_finite(options.background_color))
    throw Error(ErrorKind::usage, "--background-color is not finite");
  if (options.band_count > 0 && is_light_file(options.light))
    throw Error(ErrorKind::usage, "--bands has no effect on a light file, which has its own",
                {.file = options.light.string(), .expected = "an environment map"});
}

Lighting make_lighting(const PictureOptions& options, int transfer_band_count, Report& report) {
  const int usual = transfer_band_count > 0 ? transfer_band_count : kDefaultBandCount;
  const int band_count = options.band_count > 0 ? options.band_count : usual;
  Lighting lighting = options.light.empty() ? lighting_from(default_light(band_count))
                                            : load_lighting(options.light, band_count);
  if (transfer_band_count > 0 && lighting.light.band_count > transfer_band_count) {
    log::warning("the light has {} bands, the transfer {}: the others are cut",
                 lighting.light.band_count, transfer_band_count);
    lighting.light = sh::with_band_count(lighting.light, transfer_band_count);
    if (!lighting.is_full_map) lighting = lighting_from(lighting.light);
  }
  sh::report_window(damp(lighting, options.window, options.light.empty()), report);
  return lighting;
}

Background make_background(const PictureOptions& options, Show show) {
  const bool has_environment = show == Show::radiance && !options.light.empty();
  return options.background.value_or(has_environment ? Background::environment : Background::color);
}

void render(const RenderOptions& options, Report& report) {
  const PictureOptions& picture = options.picture;
  check_options(picture);
  if (options.sums && (options.draw == Draw::clusters || options.show != Show::radiance))
    throw Error(ErrorKind::usage, "--sums has no effect on --draw clusters and false colours",
                {.expected = "--draw single or uncompressed"});
  check_output(picture.output, picture.no_clobber);
  std::optional<StageTimer> stage(std::in_place, report, "load model");
  const Model model = load_model(picture.model, options.transfer);
  warn_of_lights_inside(model, options.near_lights);
  View view = make_view(options, model);
  stage.emplace(report, "load light");
  const Lighting lighting = make_distant_lighting(options, model, report);
  stage.emplace(report, "open OpenGL");
  const gl::HeadlessContext context({.debug = options.debug});
  log::debug("OpenGL {}", gl::description());
  report.json()["opengl"] = gl::description();
  stage.emplace(report, "upload");
  Renderer renderer;
  ExitOptions exit = options.exit;
  exit.keep_sums =
      view.sums == Sums::kept && view.draw != Draw::clusters && view.show == Show::radiance;
  renderer.set_model(model, exit);
  report.json()["pass_count"] = renderer.pass_count();
  if (!options.draw && !renderer.can_draw(view.draw, view.show)) view.draw = Draw::single;
  renderer.check_can_draw(view.draw, view.show);
  renderer.set_lighting(lighting);
  renderer.set_near_lights(options.near_lights, options.grid_size);
  turn_light(renderer, view, picture.light_rotation, report);
  stage.emplace(report, "draw");
  const bool tone_mapped =
      options.show == Show::radiance && lower_extension(picture.output) == ".png";
  const image::Image image =
      renderer.render(view, picture.width, picture.height, options.sample_count, tone_mapped);
  stage.emplace(report, "write");
  write_picture(picture.output, image,
                {.exposure = picture.exposure,
                 .tone_mapped = false,  // it is, or must not be
                 .transparent = view.background == Background::none},
                picture.no_clobber);
  stage.reset();
  report.add_input(picture.model);
  if (!options.transfer.empty()) report.add_input(options.transfer);
  if (!picture.light.empty()) report.add_input(picture.light);
  report.add_output(picture.output);
}

}  // namespace prt::runtime
