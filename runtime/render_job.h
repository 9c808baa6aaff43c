// What prt-render does, as a library: options in, a picture file out.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "camera/camera.h"
#include "core/report.h"
#include "runtime/lighting.h"
#include "runtime/renderer.h"

namespace prt::runtime {

/// Everything that says which picture is wanted, whoever renders it.
struct PictureOptions {
  std::filesystem::path model{}, output{};
  std::filesystem::path light{};       ///< .json, or an environment map; empty: default_light
  int band_count = 0;                  ///< of a projected map; 0: as many as the transfer, else 5
  std::optional<sh::Window> window{};  ///< unset: as damp() of runtime/lighting.h has it
  float light_rotation = 0.0f;         ///< degrees about +Y, counter-clockwise seen from above
  int width = 1024, height = 1024;
  std::optional<Vec3> eye{}, target{};  ///< unset: frame the model
  Vec3 up{0.0f, 1.0f, 0.0f};
  float vertical_fov = 40.0f;              ///< degrees
  float exposure = 0.0f;                   ///< stops, for .png
  std::optional<Background> background{};  ///< unset: environment, or colour without --light
                                           ///< and behind false colours
  Vec3 background_color{0.1f, 0.1f, 0.1f};
  bool no_clobber = false;
};

struct RenderOptions {
  PictureOptions picture;
  std::filesystem::path transfer;  ///< uncompressed; empty: none
  std::optional<Draw> draw;        ///< unset: uncompressed when it is given, else single
  std::optional<Sums> sums;        ///< unset: kept; not with Draw::clusters or false colours
  ExitOptions exit;
  std::vector<NearLight> near_lights{};  ///< beside the picture's light, if that is given
  int grid_size = 3;                     ///< that near lights are sampled on
  Show show = Show::radiance;
  int sample_count = 4;  ///< in a pixel; 1: at pixel centres
  bool debug = false;    ///< log OpenGL's messages
};

/// The camera that the options ask for. Throws Error (usage).
camera::Camera make_camera(const PictureOptions& options, const camera::Sphere& bounds);

/// Throws Error (usage) when a number is not finite or out of range, or --bands goes with a light
/// file, which has its own.
void check_options(const PictureOptions& options);

/// The options' light, not yet turned. A map is projected to as many bands as asked for, else as
/// many as the transfer has, else 5; bands that the transfer lacks are cut, so that the real-time
/// picture and its reference show the same light; then it is damped. `transfer_band_count` 0: no
/// transfer. Adds "window" to the report.
Lighting make_lighting(const PictureOptions& options, int transfer_band_count, Report& report);

/// What is behind the model: as asked for, else the light that was given, else a colour.
Background make_background(const PictureOptions& options, Show show);

/// Renders without a window. Adds to the report: stages, "light_change_seconds", "opengl",
/// "pass_count". Throws Error.
void render(const RenderOptions& options, Report& report);

}  // namespace prt::runtime
