// The interactive viewer: what prt-view does, as a library. A window, a model, a light; both are
// exchanged by dropping files on the window.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gl/context.h"
#include "runtime/orbit.h"
#include "runtime/renderer.h"

namespace prt::runtime {

struct ViewerOptions {
  std::filesystem::path model;       ///< empty: wait for a drop
  std::filesystem::path transfer;    ///< uncompressed; empty: none
  std::filesystem::path light;       ///< empty: default_light
  std::filesystem::path screenshot;  ///< empty: interactive; else write the window and end
  int screenshot_frame_count = 3;    ///< frames drawn before the screenshot
  std::vector<NearLight> near_lights{};
  int grid_size = 3;                   ///< that near lights are sampled on
  bool animate = false;                ///< turn the light as time goes by
  int band_count = 0;                  ///< of a projected map; 0: as the model
  std::optional<sh::Window> window{};  ///< unset: as damp() of runtime/lighting.h has it
  int width = 1280, height = 800;      ///< of the window
  Draw draw = Draw::single;
  Show show = Show::radiance;
  float exposure = 0.0f;       ///< stops
  float vertical_fov = 40.0f;  ///< degrees
  bool panel = true;           ///< draw the panel
  bool no_clobber = false;
  bool debug = false;
};

/// Dear ImGui in a window.
class UserInterface {
 public:
  explicit UserInterface(GLFWwindow* window);
  ~UserInterface();
  UserInterface(const UserInterface&) = delete;
  UserInterface& operator=(const UserInterface&) = delete;
};

class Viewer {
 public:
  /// Opens the window and loads the files. Throws Error.
  explicit Viewer(const ViewerOptions& options);
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  /// Until the window is closed or the screenshot is written. Returns seconds from the start of
  /// construction to the first frame on the screen.
  double run();

  /// What a drop does: a model (.glb .gltf), an uncompressed transfer (.transfer.exr) of the model
  /// or a light (anything else). When the file is bad, what there was stays, and message() says
  /// why.
  void open(const std::filesystem::path& path);
  const std::string& message() const { return message_; }
  /// Drawn by run() so far. A window in which nothing moves is not drawn again until an event.
  std::size_t frame_count() const { return frame_count_; }
  /// That the last change of light took, sums that are kept and OpenGL's part among it.
  double light_change_milliseconds() const { return light_change_milliseconds_; }
  /// What the panel says of the model.
  const std::string& model_text() const { return model_text_; }
  /// The distant light as it is damped against ringing, before it is turned.
  const sh::WindowedLight& light_window() const { return light_window_; }

 private:
  void load_model_file(const std::filesystem::path& model, const std::filesystem::path& transfer);
  void load_light_file(const std::filesystem::path& path);
  int wanted_band_count() const;
  void apply_input();
  void draw_frame();
  void draw_panel();
  void draw_mode_choice();
  void draw_timings();
  void draw_light_controls();
  void turn_light(float dx, float dy);
  void animate();
  void update_near_lights();
  void follow_light();
  void wait_for_events();
  void set_light_rotation(const Matrix4& world_from_light);
  void write_screenshot() const;

  static constexpr std::size_t kTimingCount = 120;

  ViewerOptions options_;
  std::chrono::steady_clock::time_point start_;
  gl::Window window_;
  UserInterface interface_;
  Renderer renderer_;
  Orbit orbit_;
  View view_;
  int sample_count_ = 4;
  std::filesystem::path model_path_;
  std::filesystem::path light_path_;  // empty: default_light
  std::string model_text_, light_text_, message_;
  sh::WindowedLight light_window_;
  int model_band_count_ = 0, light_band_count_ = 0;  // of what is loaded; 0: nothing
  Matrix4 world_from_light_;
  camera::Sphere bounds_;  // of the model
  struct {
    bool on = false;
    float azimuth = 40.0f, height = 35.0f, distance = 2.0f;  // degrees, degrees, model radii
  } lamp_;
  std::array<float, kTimingCount> frame_milliseconds_{};
  std::size_t frame_count_ = 0;
  std::size_t settled_frame_ = 3;  // from then on nothing moves until something happens
  double light_change_milliseconds_ = 0.0;
};

}  // namespace prt::runtime
