#include "runtime/reference/reference_job.h"

#include <cmath>
#include <memory>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hash.h"
#include "gltf/document.h"
#include "image/environment.h"
#include "image/prepare.h"
#include "reference/path_tracer.h"
#include "runtime/picture.h"

namespace prt::runtime {

namespace {

std::unique_ptr<reference::Illumination> make_illumination(const Lighting& lighting,
                                                           const ReferenceOptions& options) {
  const Matrix4 world_from_light = light_rotation(options.picture.light_rotation);
  if (!options.full_map)
    return std::make_unique<reference::BandLimitedIllumination>(
        sh::rotated(lighting.light, world_from_light));
  if (!lighting.is_full_map)
    throw Error(ErrorKind::usage, "--light-mode full needs an environment map",
                {.file = options.picture.light.string(), .expected = "--light MAP.exr or MAP.hdr"});
  return std::make_unique<reference::EnvironmentIllumination>(lighting.environment,
                                                              world_from_light);
}

std::string hash_of(const Lighting& lighting, const ReferenceOptions& options) {
  Hasher hasher;
  const sh::Light& light = lighting.light;
  for (const auto& channel : light.coefficients) hasher.add(std::span(channel));
  hasher.add(std::span(lighting.environment.pixels));
  hasher.add(&options.picture.light_rotation, sizeof options.picture.light_rotation);
  hasher.add(&options.full_map, sizeof options.full_map);
  return hasher.hex();
}

/// What composite.frag does: the environment in the direction of the pixel's centre, or a colour.
void put_background_behind(image::Image& image, Background background,
                           const PictureOptions& options, const camera::Camera& camera,
                           const image::Image& environment) {
  if (background == Background::none) return;
  const Matrix4 light_from_world = light_rotation(options.light_rotation).transposed();
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      float* const pixel = image.at(x, y);
      if (pixel[3] == 1.0f) continue;
      Vec3 color = options.background_color;
      if (background == Background::environment) {
        const Vec3 ray = camera.ray_direction(
            static_cast<float>(2 * x + 1) / static_cast<float>(image.width) - 1.0f,
            1.0f - static_cast<float>(2 * y + 1) / static_cast<float>(image.height));
        color = image::environment_radiance(environment, transform_vector(light_from_world, ray));
      }
      for (int c = 0; c < 3; ++c) pixel[c] += (1.0f - pixel[3]) * color[c];
    }
}

/// Root mean square of the standard error over that of the radiance.
double relative_standard_error(const reference::Result& result) {
  double error = 0.0, radiance = 0.0;
  for (const float value : result.standard_error.pixels) error += double{value} * value;
  for (std::size_t i = 0; i < result.radiance.pixels.size(); ++i)
    if (i % 4 != 3) radiance += double{result.radiance.pixels[i]} * result.radiance.pixels[i];
  return radiance > 0.0 ? std::sqrt(error / radiance) : 0.0;
}

}  // namespace

void render_reference(const ReferenceOptions& options, Report& report) {
  PictureOptions picture = options.picture;
  check_options(picture);
  if (options.full_map && picture.window)
    throw Error(ErrorKind::usage, "--window has no effect with --light-mode full",
                {.expected = "--light-mode band-limited"});
  if (options.full_map) picture.window = sh::Window::none;  // bands that ring are not seen
  check_output(picture.output, picture.no_clobber);
  const Background background = make_background(picture, Show::radiance);
  std::optional<StageTimer> stage(std::in_place, report, "load model");
  const gltf::Document document = gltf::Document::load(picture.model);
  const mesh::Scene scene = document.scene();
  const auto transfer = document.precomputed_transfer();
  const camera::Camera camera = make_camera(picture, camera::bounding_sphere(scene));
  stage.emplace(report, "load light");
  const std::string brdf = options.brdf.value_or(transfer ? transfer->brdf : "lambert");
  const Lighting lighting = make_lighting(picture, transfer ? transfer->band_count : 0, report);
  const auto illumination = make_illumination(lighting, options);
  stage.emplace(report, "trace");
  reference::Result result = reference::trace(
      scene, camera, *illumination,
      {.brdf = brdf,
       .width = picture.width,
       .height = picture.height,
       .sample_count = options.sample_count,
       .bounce_count = options.bounce_count,
       .seed = options.seed,
       .filter = options.box_filter ? reference::PixelFilter::box : reference::PixelFilter::center,
       .checkpoint = options.checkpoint,
       .illumination_key = hash_of(lighting, options)});
  stage.emplace(report, "write");
  report.json()["brdf"] = brdf;
  report.json()["resumed_share"] = result.resumed_share;
  report.json()["rays_cast"] = result.rays_cast;
  report.json()["rays_per_second"] = static_cast<double>(result.rays_cast) / result.trace_seconds;
  report.json()["sample_count"] = result.sample_count;
  report.json()["relative_standard_error"] = relative_standard_error(result);
  put_background_behind(result.radiance, background, picture, camera, lighting.environment);
  // Both or neither: a disk that has no room for the one shows it before the other is there.
  const auto noise =
      options.noise.empty()
          ? nullptr
          : image::prepare_image(options.noise, result.standard_error, picture.no_clobber);
  write_picture(picture.output, result.radiance,
                {.exposure = picture.exposure, .transparent = background == Background::none},
                picture.no_clobber);
  if (noise) noise->commit();
  remove_checkpoint(options.checkpoint.path);
  stage.reset();
  report.add_input(picture.model);
  if (!picture.light.empty()) report.add_input(picture.light);
  report.add_output(picture.output);
  if (!options.noise.empty()) report.add_output(options.noise);
}

}  // namespace prt::runtime
