#include "runtime/reference/reference_job.h"

#include <cmath>
#include <memory>

#include "core/atomic_file.h"
#include "core/error.h"
#include "gltf/document.h"
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
    throw Error(ErrorKind::usage, "the full light mode needs an environment map",
                {.file = options.picture.light.string(), .expected = "an .exr or .hdr map"});
  return std::make_unique<reference::EnvironmentIllumination>(lighting.environment,
                                                              world_from_light);
}

void put_color_behind(image::Image& image, const Vec3& color) {
  for (std::size_t i = 0; i < image.pixels.size(); i += 4)
    for (std::size_t c = 0; c < 3; ++c)
      image.pixels[i + c] += (1.0f - image.pixels[i + 3]) * color[static_cast<int>(c)];
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
  const PictureOptions& picture = options.picture;
  check_output(picture.output, picture.no_clobber);
  const Background background = picture.background.value_or(Background::environment);
  std::optional<StageTimer> stage(std::in_place, report, "load model");
  const mesh::Scene scene = gltf::Document::load(picture.model).scene();
  const camera::Camera camera = make_camera(picture, camera::bounding_sphere(scene));
  stage.emplace(report, "load light");
  const Lighting lighting = make_lighting(picture, 0);
  const auto illumination = make_illumination(lighting, options);
  stage.emplace(report, "trace");
  reference::Result result = reference::trace(
      scene, camera, *illumination,
      {.width = picture.width,
       .height = picture.height,
       .sample_count = options.sample_count,
       .bounce_count = options.bounce_count,
       .seed = options.seed,
       .filter = options.box_filter ? reference::PixelFilter::box : reference::PixelFilter::center,
       .background = background == Background::environment});
  stage.emplace(report, "write");
  report.json()["rays_cast"] = result.rays_cast;
  report.json()["rays_per_second"] = static_cast<double>(result.rays_cast) / result.trace_seconds;
  report.json()["sample_count"] = result.sample_count;
  report.json()["relative_standard_error"] = relative_standard_error(result);
  if (background == Background::color) put_color_behind(result.radiance, picture.background_color);
  write_picture(picture.output, result.radiance,
                {.exposure = picture.exposure, .transparent = background == Background::none},
                picture.no_clobber);
  stage.reset();
  report.add_input(picture.model);
  if (!picture.light.empty()) report.add_input(picture.light);
  report.add_output(picture.output);
}

}  // namespace prt::runtime
