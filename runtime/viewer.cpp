#include "runtime/viewer.h"

#include <epoxy/gl.h>
// GLFW comes after epoxy, which stands in for the system's OpenGL header.
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "image/image.h"
#include "runtime/light_inside.h"
#include "runtime/picture.h"

namespace prt::runtime {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

namespace {

void open_dropped(GLFWwindow* window, int count, const char** paths) {
  auto* const viewer = static_cast<Viewer*>(glfwGetWindowUserPointer(window));
  for (int i = 0; i < count; ++i) viewer->open(paths[i]);
}

std::string describe(const fs::path& path, const Model& model, int pass_count) {
  std::string text =
      fmt::format("{}\n{} vertices, {} triangles\n{}, {} bands", path.filename().string(),
                  model.positions.size(), model.indices.size() / 3,
                  model.transfer ? model.transfer->brdf : model.signal->brdf, model.band_count());
  if (model.row_count() > 1)
    text += fmt::format(", {} exit rows, {}", model.row_count(),
                        pass_count == 1 ? "one pass" : "a pass a colour");
  if (model.transfer)
    text += fmt::format("\n{} clusters, {} components", model.transfer->encoding.cluster_count,
                        model.transfer->encoding.component_count);
  if (model.transfer && model.signal)
    text += fmt::format("\nerror of the compression: {:.2f}%", 100.0f * relative_error(model));
  return text;
}

}  // namespace

UserInterface::UserInterface(GLFWwindow* window) {
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // leave no file behind
  ImGui::StyleColorsDark();
  ImGui_ImplGlfw_InitForOpenGL(window, true);
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

UserInterface::~UserInterface() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

Viewer::Viewer(const ViewerOptions& options)
    : options_(options),
      start_(Clock::now()),
      window_("prt-view", options.width, options.height, {.debug = options.debug}),
      interface_(window_.handle()) {
  check_exposure(options_.exposure);
  if (!options_.screenshot.empty()) check_output(options_.screenshot, options_.no_clobber);
  log::debug("OpenGL {}", gl::description());
  glfwSetWindowUserPointer(window_.handle(), this);
  glfwSetDropCallback(window_.handle(), open_dropped);
  view_.draw = options_.draw;
  view_.show = options_.show;
  view_.exposure = options_.exposure;
  view_.background_color = Vec3(0.03f);
  if (!options_.model.empty() || !options_.transfer.empty())
    load_model_file(options_.model, options_.transfer);
  const bool is_default = options_.draw == Draw::single && options_.show == Show::radiance;
  if (!options_.model.empty() && !is_default)
    renderer_.check_can_draw(options_.draw, options_.show);
  load_light_file(options_.light);
}

double Viewer::run() {
  double start_seconds = 0.0;
  const bool interactive = options_.screenshot.empty();
  while (!glfwWindowShouldClose(window_.handle())) {
    if (interactive && !options_.animate && frame_count_ >= settled_frame_)
      wait_for_events();
    else
      glfwPollEvents();
    const auto frame_start = Clock::now();
    draw_frame();
    if (!interactive &&
        frame_count_ + 1 >= static_cast<std::size_t>(options_.screenshot_frame_count)) {
      write_screenshot();
      glfwSetWindowShouldClose(window_.handle(), GLFW_TRUE);
    }
    glfwSwapBuffers(window_.handle());
    const auto now = Clock::now();
    frame_milliseconds_[frame_count_ % kTimingCount] =
        std::chrono::duration<float, std::milli>(now - frame_start).count();
    if (frame_count_++ == 0) start_seconds = std::chrono::duration<double>(now - start_).count();
  }
  return start_seconds;
}

/// Any event can change what is shown; the panel takes some frames to show all that follows.
void Viewer::wait_for_events() {
  constexpr std::size_t kFramesToSettle = 3;
  glfwWaitEvents();
  settled_frame_ = frame_count_ + kFramesToSettle;
}

void Viewer::open(const fs::path& path) {
  try {
    const std::string kind = lower_extension(path);
    if (kind == ".glb" || kind == ".gltf")
      load_model_file(path, {});
    else if (kind == ".exr" && lower_extension(path.stem()) == ".transfer")
      load_model_file(model_path_, path);
    else
      load_light_file(path);
    renderer_.prepare(view_);
    message_.clear();
  } catch (const std::exception& error) {
    message_ = error.what();
  }
}

void Viewer::load_model_file(const fs::path& path, const fs::path& transfer) {
  if (path.empty()) throw Error(ErrorKind::usage, "open a model before its transfer");
  const Model model = load_model(path, transfer);
  renderer_.set_model(model);
  warn_of_lights_inside(model, options_.near_lights);
  const bool same_model = path == model_path_;
  model_path_ = path;
  model_band_count_ = model.band_count();
  if (!same_model)
    orbit_ = Orbit(
        camera::frame(model.bounds, options_.vertical_fov,
                      static_cast<float>(options_.width) / static_cast<float>(options_.height)));
  bounds_ = model.bounds;
  update_near_lights();
  model_text_ = describe(path, model, renderer_.pass_count());
  for (const Draw draw : {Draw::single, Draw::uncompressed})
    if (!renderer_.can_draw(view_.draw, view_.show)) {
      view_.draw = draw;
      view_.show = Show::radiance;
    }
  if (light_band_count_ > 0 && light_band_count_ != wanted_band_count())
    load_light_file(light_path_);
}

int Viewer::wanted_band_count() const {
  if (options_.band_count > 0) return options_.band_count;
  return model_band_count_ > 0 ? model_band_count_ : 5;
}

void Viewer::load_light_file(const fs::path& path) {
  const int bands = wanted_band_count();
  const bool only_near = path.empty() && !options_.near_lights.empty();
  Lighting lighting = only_near      ? lighting_from(sh::Light(bands))
                      : path.empty() ? lighting_from(default_light(bands))
                                     : load_lighting(path, bands);
  light_window_ = damp(lighting, options_.window, path.empty());
  renderer_.set_lighting(lighting);
  light_path_ = path;
  light_band_count_ = bands;
  view_.background = path.empty() ? Background::color : Background::environment;
  light_text_ = path.empty() ? lighting.light.source : path.filename().string();
}

void Viewer::set_light_rotation(const Matrix4& world_from_light) {
  world_from_light_ = world_from_light;
  renderer_.set_light_rotation(world_from_light_);
}

void Viewer::update_near_lights() {
  std::vector<NearLight> lights = options_.near_lights;
  if (lamp_.on) {
    const Matrix4 turn = light_rotation(lamp_.azimuth);
    const float height = lamp_.height * std::numbers::pi_v<float> / 180.0f;
    const Vec3 direction = transform_vector(turn, Vec3(0, std::sin(height), std::cos(height)));
    lights.push_back({bounds_.center + direction * (lamp_.distance * bounds_.radius),
                      0.25f * bounds_.radius, Vec3(40.0f, 36.0f, 30.0f)});
  }
  renderer_.set_near_lights(std::move(lights), options_.grid_size);
}

/// To the end, kept sums and all, and without what OpenGL still had to do.
void Viewer::follow_light() {
  if (!renderer_.light_changed()) return;
  gl::finish();
  const auto start = Clock::now();
  renderer_.prepare(view_);
  gl::finish();
  light_change_milliseconds_ =
      std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

void Viewer::draw_frame() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  apply_input();
  animate();
  if (options_.panel) draw_panel();
  ImGui::Render();
  follow_light();
  const gl::Window::Size size = window_.framebuffer_size();
  if (size.width > 0 && size.height > 0) {  // not minimised
    view_.camera = orbit_.camera(static_cast<float>(size.width) / static_cast<float>(size.height));
    renderer_.draw(view_, size.width, size.height, sample_count_);
    gl::bind_window(size.width, size.height);
    renderer_.develop(view_);
  }
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Viewer::write_screenshot() const {
  const gl::Window::Size size = window_.framebuffer_size();
  image::write_image(options_.screenshot, gl::read_window(size.width, size.height),
                     options_.no_clobber);
}

}  // namespace prt::runtime
