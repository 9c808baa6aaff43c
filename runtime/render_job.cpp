#include "runtime/render_job.h"

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/log.h"
#include "gl/context.h"
#include "runtime/picture.h"

namespace prt::runtime {

namespace {

constexpr int kDefaultBandCount = 5;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

View make_view(const RenderOptions& options, const Model& model) {
  View view;
  view.camera = make_camera(options.picture, model.bounds);
  view.draw = options.draw.value_or(model.signal ? Draw::uncompressed : Draw::single);
  view.show = options.show;
  const bool has_environment = options.show == Show::radiance && !options.picture.light.empty();
  view.background = options.picture.background.value_or(has_environment ? Background::environment
                                                                        : Background::color);
  view.background_color = options.picture.background_color;
  view.exposure = options.picture.exposure;
  return view;
}

void check_drawable(const Renderer& renderer, const View& view) {
  if (renderer.can_draw(view.draw, view.show)) return;
  const bool needs_both = view.show == Show::error;
  throw Error(ErrorKind::usage, "the files lack the transfer for this picture",
              {.expected = needs_both ? "both compressed and uncompressed transfer"
                           : view.draw == Draw::uncompressed && view.show == Show::radiance
                               ? "uncompressed transfer"
                               : "compressed transfer",
               .advice = "Give a .glb of prt-compress, and --transfer for uncompressed transfer."});
}

/// Times that people compare: one more frame and one more change of light, everything warm.
void measure(Renderer& renderer, const View& view, const RenderOptions& options, Report& report) {
  const Matrix4 world_from_light = light_rotation(options.picture.light_rotation);
  gl::finish();
  const auto light_start = std::chrono::steady_clock::now();
  renderer.set_light_rotation(world_from_light);
  report.json()["light_change_seconds"] = seconds_since(light_start);
  gl::finish();
  const auto frame_start = std::chrono::steady_clock::now();
  renderer.draw(view, options.picture.width, options.picture.height, options.sample_count);
  gl::finish();
  report.json()["frame_seconds"] = seconds_since(frame_start);
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

Lighting make_lighting(const PictureOptions& options, int band_count) {
  if (options.band_count > 0) band_count = options.band_count;
  if (band_count == 0) band_count = kDefaultBandCount;
  return options.light.empty() ? lighting_from(default_light(band_count))
                               : load_lighting(options.light, band_count);
}

void render(const RenderOptions& options, Report& report) {
  const PictureOptions& picture = options.picture;
  check_output(picture.output, picture.no_clobber);
  std::optional<StageTimer> stage(std::in_place, report, "load model");
  const Model model = load_model(picture.model, options.transfer);
  const View view = make_view(options, model);
  stage.emplace(report, "load light");
  const Lighting lighting = make_lighting(picture, model.band_count());
  stage.emplace(report, "open OpenGL");
  const gl::HeadlessContext context({.debug = options.debug});
  log::debug("OpenGL {}", gl::description());
  report.json()["opengl"] = gl::description();
  stage.emplace(report, "upload");
  Renderer renderer;
  renderer.set_model(model);
  check_drawable(renderer, view);
  renderer.set_lighting(lighting);
  renderer.set_light_rotation(light_rotation(picture.light_rotation));
  stage.emplace(report, "draw");
  const image::Image image =
      renderer.render(view, picture.width, picture.height, options.sample_count);
  stage.emplace(report, "measure");
  measure(renderer, view, options, report);
  stage.emplace(report, "write");
  write_picture(picture.output, image,
                {.exposure = picture.exposure,
                 .tone_mapped = options.show == Show::radiance,
                 .transparent = view.background == Background::none},
                picture.no_clobber);
  stage.reset();
  report.add_input(picture.model);
  if (!options.transfer.empty()) report.add_input(options.transfer);
  if (!picture.light.empty()) report.add_input(picture.light);
  report.add_output(picture.output);
}

}  // namespace prt::runtime
