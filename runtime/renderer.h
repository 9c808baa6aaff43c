// Draws a model under a light: the part that prt-render and prt-view share. Needs a current OpenGL
// context, which must outlive it.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "camera/camera.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "image/image.h"
#include "runtime/exit_stage.h"
#include "runtime/light_field.h"
#include "runtime/lighting.h"
#include "runtime/model.h"

namespace prt::runtime {

/// How transfer is drawn: compressed in one call, compressed by clusters, or uncompressed.
enum class Draw { single, clusters, uncompressed };
/// When exit values of compressed transfer in one call, or uncompressed transfer, are summed: when
/// the light changes, to be kept until it does again (where there is room, runtime/exit_buffer.h; a
/// warning tells where not), or in every frame for every vertex that is shaded, as the paper does.
/// By clusters it is every frame.
enum class Sums { kept, every_frame };
/// What is shown: exit radiance, or false-colour pictures of the compression.
enum class Show { radiance, clusters, superclusters, error };
enum class Background { none, color, environment };

struct View {
  camera::Camera camera;
  Draw draw = Draw::single;
  Sums sums = Sums::kept;
  Show show = Show::radiance;
  Background background = Background::environment;
  Vec3 background_color{0.0f, 0.0f, 0.0f};  ///< linear
  float exposure = 0.0f;                    ///< stops, on screens and in 8-bit pictures
};

/// The relative error (runtime/model.h) that is shown red.
constexpr float kErrorScale = 0.1f;

class Renderer {
 public:
  /// Draws to textures of this format; the default is the finest that the context can blend.
  Renderer();
  explicit Renderer(gl::Format float_format);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Takes the place of the model before; that one stays when this throws.
  void set_model(const Model& model, const ExitOptions& options = {});
  /// Light and background.
  void set_lighting(const Lighting& lighting);
  /// Turns light and background; the light of set_lighting is what is turned.
  void set_light_rotation(const Matrix4& world_from_light);
  /// Beside the distant light; sampled at `grid_size`³ points of a grid over the model, 1 to
  /// kMaxGridSize. They are not turned.
  void set_near_lights(std::vector<NearLight> lights, int grid_size);

  /// What draw() would do first of all: where light or model have changed, the work that follows
  /// from it, once for all changes since, and the kept sums that the view needs.
  void prepare(const View& view);
  /// Whether the next prepare() has light to work on.
  bool light_changed() const { return drawings_ && light_changed_; }
  /// Changes of light that have been worked on.
  int light_update_count() const { return light_update_count_; }

  bool can_draw(Draw draw, Show show) const;
  /// Throws Error (usage) saying which transfer is missing, or Error (failed) where the
  /// uncompressed one is too large for this OpenGL.
  void check_can_draw(Draw draw, Show show) const;
  /// That the model is drawn in; 0 without one.
  int pass_count() const;

  /// Draws one frame into a float texture: linear radiance, premultiplied by coverage, no
  /// background. `samples` in a pixel, cut to what the driver has; 1: at pixel centres.
  void draw(const View& view, int width, int height, int samples);
  /// Puts the background behind the last frame and develops it into the bound framebuffer of the
  /// same size: sample by sample where the driver lets shaders read them (OpenGL, not OpenGL ES),
  /// so that edges of what is much brighter than white are smooth.
  void develop(const View& view);

  /// Draws and returns linear RGBA with the background composed; alpha is the model's coverage.
  /// `tone_mapped`: exposed and tone mapped as develop() does it, but not put on the sRGB curve.
  image::Image render(const View& view, int width, int height, int samples,
                      bool tone_mapped = false);

 private:
  struct Drawings;
  void composite(const View& view, int output);

  gl::VertexArray no_attributes_;
  gl::Program composite_program_;
  std::optional<gl::Program> sample_program_;  // the same, of each sample, where that can be
  gl::Format float_format_;
  gl::Target frame_;
  gl::Target sum_target_;  // captures draw nothing, but need one
  int frame_samples_ = 0;
  gl::Texture environment_;
  sh::Light light_;
  std::vector<NearLight> near_lights_;
  int grid_size_ = 1;
  Matrix4 world_from_light_;
  bool light_changed_ = false;
  int light_update_count_ = 0;
  std::unique_ptr<Drawings> drawings_;
};

}  // namespace prt::runtime
