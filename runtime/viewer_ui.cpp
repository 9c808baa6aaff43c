// The viewer's panel and its mouse.
#include <fmt/format.h>
#include <imgui.h>
// GLFW's names of keys; its functions are not needed here.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <numbers>

#include "image/false_color.h"
#include "image/srgb.h"
#include "runtime/viewer.h"

namespace prt::runtime {

namespace {

struct Mode {
  const char* name;
  Draw draw;
  Show show;
};

constexpr Mode kModes[] = {{"Compressed, one draw", Draw::single, Show::radiance},
                           {"Compressed, by clusters", Draw::clusters, Show::radiance},
                           {"Uncompressed", Draw::uncompressed, Show::radiance},
                           {"Cluster colours", Draw::single, Show::clusters},
                           {"Supercluster colours", Draw::single, Show::superclusters},
                           {"Error heat map", Draw::single, Show::error}};

bool is_current(const Mode& mode, const View& view) {
  return mode.show == view.show && (mode.show != Show::radiance || mode.draw == view.draw);
}

/// A bar of the heat map's colours with what they stand for below it.
void draw_error_scale() {
  constexpr float kWidth = 240.0f, kHeight = 14.0f, kSlice = 2.0f;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (float x = 0.0f; x < kWidth; x += kSlice) {
    const Vec3 color = image::heat_color(x / (kWidth - kSlice));
    list.AddRectFilled(
        {corner.x + x, corner.y}, {corner.x + x + kSlice, corner.y + kHeight},
        ImGui::GetColorU32({image::srgb_from_linear(color.x), image::srgb_from_linear(color.y),
                            image::srgb_from_linear(color.z), 1.0f}));
  }
  ImGui::Dummy({kWidth, kHeight});
  const auto label = [](const std::string& text, float place) {  // 0: left, 1: right
    const float free = kWidth - ImGui::CalcTextSize(text.c_str()).x;
    if (place > 0.0f) ImGui::SameLine(ImGui::GetStyle().WindowPadding.x + place * free);
    ImGui::TextUnformatted(text.c_str());
  };
  label("0", 0.0f);
  label(fmt::format("{:g}%", 50.0f * kErrorScale), 0.5f);
  label(fmt::format("{:g}% and more", 100.0f * kErrorScale), 1.0f);
  ImGui::TextUnformatted("error of a vertex, of the transfer's RMS");
}

}  // namespace

void Viewer::apply_input() {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantCaptureMouse || io.DisplaySize.y <= 0.0f) return;
  const float dx = io.MouseDelta.x, dy = io.MouseDelta.y, height = io.DisplaySize.y;
  const bool left = ImGui::IsMouseDown(ImGuiMouseButton_Left);
  if (ImGui::IsMouseDown(ImGuiMouseButton_Right) || (left && io.KeyShift))
    turn_light(dx, dy);
  else if (ImGui::IsMouseDown(ImGuiMouseButton_Middle) || (left && io.KeyCtrl))
    orbit_.pan(dx, dy, height);
  else if (left)
    orbit_.rotate(dx, dy, height);
  if (io.MouseWheel != 0.0f) orbit_.zoom(io.MouseWheel);
}

void Viewer::turn_light(float dx, float dy) {
  if (dx == 0.0f && dy == 0.0f) return;
  const float radians_per_pixel = std::numbers::pi_v<float> / ImGui::GetIO().DisplaySize.y;
  const Matrix4 about_up = turned(world_from_light_, Vec3(0, 1, 0), dx * radians_per_pixel);
  set_light_rotation(turned(about_up, view_.camera.axes().right, dy * radians_per_pixel));
}

void Viewer::animate() {
  if (!ImGui::GetIO().WantCaptureKeyboard && ImGui::IsKeyPressed(GLFW_KEY_SPACE, false))
    options_.animate = !options_.animate;
  if (!options_.animate) return;
  constexpr float kRadiansPerSecond = 0.5f;
  constexpr float kLongestStep = 0.1f;  // seconds; the window may have waited before
  set_light_rotation(turned(world_from_light_, Vec3(0, 1, 0),
                            kRadiansPerSecond * std::min(kLongestStep, ImGui::GetIO().DeltaTime)));
}

void Viewer::draw_light_controls() {
  ImGui::Text("Light: %s", light_text_.c_str());
  bool background = view_.background == Background::environment;
  if (ImGui::Checkbox("Background", &background))
    view_.background = background ? Background::environment : Background::color;
  ImGui::SameLine();
  ImGui::Checkbox("Turn (space)", &options_.animate);
  ImGui::SameLine();
  if (ImGui::Button("Reset")) set_light_rotation(Matrix4());
  bool changed = ImGui::Checkbox("Lamp near the model", &lamp_.on);
  if (lamp_.on) {
    changed |= ImGui::SliderFloat("Azimuth", &lamp_.azimuth, -180.0f, 180.0f, "%.0f deg");
    changed |= ImGui::SliderFloat("Height", &lamp_.height, -90.0f, 90.0f, "%.0f deg");
    changed |= ImGui::SliderFloat("Distance", &lamp_.distance, 1.3f, 6.0f, "%.1f radii");
  }
  if (lamp_.on || !options_.near_lights.empty())
    changed |= ImGui::SliderInt("Samples a side", &options_.grid_size, 1, kMaxGridSize);
  if (changed) update_near_lights();
}

void Viewer::draw_panel() {
  ImGui::SetNextWindowPos({12, 12}, ImGuiCond_FirstUseEver);
  ImGui::Begin("prtkit", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
  if (model_text_.empty())
    ImGui::TextUnformatted("Drop a baked .glb here");
  else
    ImGui::TextUnformatted(model_text_.c_str());
  ImGui::Separator();
  draw_mode_choice();
  if (view_.show == Show::error) draw_error_scale();
  bool kept = view_.sums == Sums::kept;
  if (ImGui::Checkbox("Sums kept while the light stays", &kept))
    view_.sums = kept ? Sums::kept : Sums::every_frame;
  ImGui::SliderFloat("Exposure", &view_.exposure, -6.0f, 6.0f, "%+.1f stops");
  draw_light_controls();
  ImGui::Separator();
  draw_timings();
  ImGui::TextDisabled(
      "drag: orbit   right or shift drag: light\nmiddle or ctrl drag: pan   wheel: zoom");
  if (!message_.empty()) {
    ImGui::Separator();
    ImGui::PushTextWrapPos(380.0f);
    ImGui::TextColored({1.0f, 0.45f, 0.4f, 1.0f}, "%s", message_.c_str());
    ImGui::PopTextWrapPos();
    if (ImGui::SmallButton("Dismiss")) message_.clear();
  }
  ImGui::End();
}

void Viewer::draw_mode_choice() {
  const auto current = std::find_if(std::begin(kModes), std::end(kModes),
                                    [&](const Mode& mode) { return is_current(mode, view_); });
  if (!ImGui::BeginCombo("Show", current->name)) return;
  for (const Mode& mode : kModes) {
    const bool possible = renderer_.can_draw(mode.draw, mode.show);
    const ImGuiSelectableFlags flags = possible ? 0 : ImGuiSelectableFlags_Disabled;
    if (!ImGui::Selectable(mode.name, &mode == current, flags)) continue;
    view_.draw = mode.draw;
    view_.show = mode.show;
  }
  ImGui::EndCombo();
}

void Viewer::draw_timings() {
  const std::size_t known_count = std::min(frame_count_, kTimingCount);
  const float last =
      known_count > 0 ? frame_milliseconds_[(frame_count_ - 1) % kTimingCount] : 0.0f;
  const float slowest = *std::max_element(frame_milliseconds_.begin(), frame_milliseconds_.end());
  const std::string text = fmt::format("{:.1f} ms", last);
  ImGui::PlotLines("Frame", frame_milliseconds_.data(), static_cast<int>(kTimingCount),
                   static_cast<int>(frame_count_ % kTimingCount), text.c_str(), 0.0f,
                   1.2f * slowest, {240, 48});
  ImGui::Text("Last light change: %.2f ms", light_change_milliseconds_);
}

}  // namespace prt::runtime
