#include "runtime/renderer.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "core/log.h"
#include "cpca/superclusters.h"
#include "gl/context.h"
#include "image/false_color.h"
#include "runtime/model_drawing.h"
#include "runtime/shading.h"

namespace prt::runtime {

namespace {

// Of composite.frag.
enum Output { kLinear = 0, kSrgb = 1, kToneMapped = 2, kToneMappedLinear = 3 };

/// Means of blocks of `factor`² pixels, the last ones of a row or column smaller.
image::Image reduced(const image::Image& map, int factor) {
  image::Image small((map.width + factor - 1) / factor, (map.height + factor - 1) / factor, 3);
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      const int x_end = std::min((x + 1) * factor, map.width);
      const int y_end = std::min((y + 1) * factor, map.height);
      const auto count = static_cast<float>((x_end - x * factor) * (y_end - y * factor));
      for (int j = y * factor; j < y_end; ++j)
        for (int i = x * factor; i < x_end; ++i)
          for (int c = 0; c < 3; ++c) small.at(x, y)[c] += map.at(i, j)[c] / count;
    }
  return small;
}

gl::Texture make_environment_texture(const image::Image& map) {
  const int limit = gl::limits().max_texture_size;
  const int factor = (std::max(map.width, map.height) + limit - 1) / limit;
  if (factor > 1) return make_environment_texture(reduced(map, factor));
  const std::size_t texel_count = map.pixels.size() / 3;
  std::vector<float> rgba(4 * texel_count, 1.0f);
  for (std::size_t i = 0; i < texel_count; ++i) std::copy_n(&map.pixels[3 * i], 3, &rgba[4 * i]);
  return gl::Texture(gl::Format::rgba32f, map.width, map.height, rgba.data());
}

std::vector<Vec3> label_colors(const std::vector<std::uint32_t>& labels) {
  std::vector<Vec3> colors;
  for (const std::uint32_t label : labels) colors.push_back(image::cluster_color(label));
  return colors;
}

/// Without superclusters, each cluster is one.
std::vector<std::uint32_t> supercluster_labels(const gltf::PrecomputedTransfer& transfer) {
  if (transfer.first_clusters.empty()) return transfer.encoding.cluster_of_point;
  return cpca::superclusters_of_points(transfer.encoding, transfer.first_clusters);
}

/// As a grid's, around all positions.
LightGrid box_of(const std::vector<Vec3>& positions) {
  LightGrid grid;
  if (positions.empty()) return grid;
  grid.low = grid.high = positions.front();
  for (const Vec3& p : positions)
    for (int axis = 0; axis < 3; ++axis) {
      grid.low[axis] = std::min(grid.low[axis], p[axis]);
      grid.high[axis] = std::max(grid.high[axis], p[axis]);
    }
  return grid;
}

std::vector<Vec3> error_colors(const Model& model) {
  std::vector<Vec3> colors;
  for (const float error : relative_errors(model))
    colors.push_back(image::heat_color(error / kErrorScale));
  return colors;
}

bool can_keep_sums(const ExitLayout& layout, std::size_t vertex_count) {
  if (ExitBuffer::fits(layout, vertex_count)) return true;
  log::warning(
      "what {} vertices send does not fit what this OpenGL captures or holds in a texture: it is "
      "summed in every frame",
      vertex_count);
  return false;
}

}  // namespace

struct Renderer::Drawings {
  Drawings(const Model& model, const ExitOptions& options)
      : bounds(model.bounds),
        band_count(model.band_count()),
        grid(box_of(model.positions)),
        positions(std::span(model.positions)),
        indices(std::span(model.indices)),
        exit(model, options),
        keep_sums(options.keep_sums && can_keep_sums(exit.layout(), model.positions.size())),
        black(model.indices.size(), positions, indices) {
    if (model.transfer) {
      compressed.emplace(model, exit, positions, indices, keep_sums);
      const std::size_t index_count = model.indices.size();
      clusters.emplace(label_colors(model.transfer->encoding.cluster_of_point), index_count,
                       positions, indices);
      superclusters.emplace(label_colors(supercluster_labels(*model.transfer)), index_count,
                            positions, indices);
    }
    if (model.signal) add_uncompressed(model);
    if (model.transfer && model.signal)
      error.emplace(error_colors(model), model.indices.size(), positions, indices);
  }

  /// Where matrices are too many for a texture, compressed transfer is drawn all the same.
  void add_uncompressed(const Model& model) {
    uncompressed_fits = UncompressedDrawing::fits(*model.signal, exit.layout());
    if (uncompressed_fits || !model.transfer)
      uncompressed.emplace(model, exit, positions, indices, keep_sums);
    else
      log::warning("the uncompressed transfer does not fit a texture of this OpenGL: not drawn");
  }

  void draw(const View& view, int samples) {
    const camera::DepthRange range = camera::depth_range(view.camera, bounds);
    const camera::Camera::Axes axes = view.camera.axes();
    const Viewpoint viewpoint{view.camera.clip_from_world(range.z_near, range.z_far),
                              view.camera.eye, axes.right, axes.backward};
    if (view.show == Show::clusters) return clusters->draw(viewpoint);
    if (view.show == Show::superclusters) return superclusters->draw(viewpoint);
    if (view.show == Show::error) return error->draw(viewpoint);
    // Diffuse pixels are too cheap for black ones first, unless samples of a pixel are to be the
    // same for all ways of drawing.
    const bool is_cheap = !exit.layout().is_glossy() && samples == 1;
    if (is_cheap && view.draw != Draw::clusters) return draw_fronts(view, viewpoint);
    // The front of what is nearest, over everything in black: no pixel is shaded twice, and what a
    // pixel covers is the same for every way of drawing.
    black.draw(viewpoint);
    glEnable(GL_CULL_FACE);
    glDepthFunc(GL_EQUAL);
    glDepthMask(GL_FALSE);
    draw_fronts(view, viewpoint);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glDisable(GL_CULL_FACE);
  }

  void draw_fronts(const View& view, const Viewpoint& viewpoint) {
    const bool keep = view.sums == Sums::kept;
    if (view.draw == Draw::clusters) return compressed->draw_clusters(viewpoint);
    if (view.draw == Draw::single) {
      if (!keep || !compressed->draw_kept(viewpoint)) compressed->draw_single(viewpoint);
    } else {
      if (!keep || !uncompressed->draw_kept(viewpoint)) uncompressed->draw(viewpoint);
    }
  }

  void sum(const View& view) {
    if (view.show != Show::radiance || view.sums != Sums::kept) return;
    if (view.draw == Draw::single) compressed->sum();
    if (view.draw == Draw::uncompressed) uncompressed->sum();
  }

  void set_light(const LightField& field) {
    if (compressed) compressed->set_light(field);
    if (uncompressed) uncompressed->set_light(field);
  }

  camera::Sphere bounds;
  int band_count;
  LightGrid grid;
  gl::Buffer positions, indices;
  ExitStage exit;
  bool keep_sums;
  bool uncompressed_fits = true;
  BlackDrawing black;
  std::optional<CompressedDrawing> compressed;
  std::optional<UncompressedDrawing> uncompressed;
  std::optional<ColorDrawing> clusters, superclusters, error;
};

Renderer::Renderer()
    : Renderer(gl::limits().float32_targets ? gl::Format::rgba32f : gl::Format::rgba16f) {}

Renderer::Renderer(gl::Format float_format)
    : composite_program_("fullscreen.vert", "composite.frag"),
      float_format_(float_format),
      sum_target_(float_format, 1, 1, false, 1) {
  if (gl::limits().sample_textures)
    sample_program_.emplace("fullscreen.vert", "composite.frag", gl::Defines{"SAMPLES"});
  const float black[4] = {0.0f, 0.0f, 0.0f, 1.0f};
  environment_ = gl::Texture(gl::Format::rgba32f, 1, 1, black);
}

Renderer::~Renderer() = default;

void Renderer::set_model(const Model& model, const ExitOptions& options) {
  drawings_ = std::make_unique<Drawings>(model, options);
  light_changed_ = true;
}

void Renderer::set_lighting(const Lighting& lighting) {
  environment_ = make_environment_texture(lighting.environment);
  light_ = lighting.light;
  light_changed_ = true;
}

void Renderer::set_light_rotation(const Matrix4& world_from_light) {
  world_from_light_ = world_from_light;
  light_changed_ = true;
}

void Renderer::set_near_lights(std::vector<NearLight> lights, int grid_size) {
  near_lights_ = std::move(lights);
  grid_size_ = grid_size;
  light_changed_ = true;
}

void Renderer::prepare(const View& view) {
  if (!drawings_) return;
  if (std::exchange(light_changed_, false)) {
    LightGrid grid = drawings_->grid;
    grid.size = grid_size_;
    const sh::Light distant = sh::with_band_count(light_, drawings_->band_count);
    drawings_->set_light(light_field(sh::rotated(distant, world_from_light_), near_lights_, grid));
    ++light_update_count_;
  }
  if (!can_draw(view.draw, view.show)) return;
  sum_target_.bind();
  drawings_->sum(view);
}

int Renderer::pass_count() const { return drawings_ ? drawings_->exit.layout().pass_count : 0; }

bool Renderer::can_draw(Draw draw, Show show) const {
  if (!drawings_) return false;
  if (show == Show::clusters || show == Show::superclusters) return drawings_->clusters.has_value();
  if (show == Show::error) return drawings_->error.has_value();
  if (draw == Draw::uncompressed) return drawings_->uncompressed.has_value();
  return drawings_->compressed.has_value();
}

void Renderer::check_can_draw(Draw draw, Show show) const {
  if (can_draw(draw, show)) return;
  if (drawings_ && !drawings_->uncompressed_fits && draw == Draw::uncompressed)
    throw_failed("the uncompressed transfer does not fit a texture of this OpenGL",
                 {.advice = "Draw the compressed one."});
  throw Error(
      ErrorKind::usage, "the files lack the transfer for this picture",
      {.expected = show == Show::error ? "both compressed and uncompressed transfer"
                   : draw == Draw::uncompressed && show == Show::radiance ? "uncompressed transfer"
                                                                          : "compressed transfer",
       .advice = "Give a .glb of prt-compress, and --transfer for uncompressed transfer."});
}

void Renderer::draw(const View& view, int width, int height, int samples) {
  prepare(view);
  samples = std::clamp(samples, 1, std::max(gl::limits().max_samples, 1));
  if (width != frame_.width() || height != frame_.height() || samples != frame_samples_) {
    frame_ = gl::Target(float_format_, width, height, true, samples);
    frame_samples_ = samples;
  }
  frame_.bind();
  glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  if (can_draw(view.draw, view.show)) {
    glEnable(GL_DEPTH_TEST);
    drawings_->draw(view, samples);
    glDisable(GL_DEPTH_TEST);
  }
  gl::check_errors("drawing the model");
}

void Renderer::composite(const View& view, int output) {
  const camera::Camera::Axes axes = view.camera.axes();
  const float tangent = std::tan(view.camera.vertical_fov * std::numbers::pi_v<float> / 360.0f);
  const Matrix4 light_from_world = world_from_light_.transposed();
  const bool by_sample = output >= kToneMapped && frame_samples_ > 1 && sample_program_;
  const gl::Program& program = by_sample ? *sample_program_ : composite_program_;
  if (!by_sample) frame_.resolve();
  program.use();
  program.set("u_scene", 0);
  program.set("u_environment", 1);
  program.set("u_background", static_cast<int>(view.background));
  program.set("u_background_color", view.background_color);
  program.set("u_ray_right",
              transform_vector(light_from_world, axes.right * (tangent * view.camera.aspect)));
  program.set("u_ray_up", transform_vector(light_from_world, axes.up * tangent));
  program.set("u_ray_forward", transform_vector(light_from_world, -axes.backward));
  program.set("u_output", output);
  program.set("u_exposure", std::exp2(view.exposure));
  if (by_sample) {
    program.set("u_sample_count", frame_samples_);
    frame_.bind_samples(0);
  } else {
    frame_.color().bind(0);
  }
  environment_.bind(1);
  gl::draw_fullscreen(no_attributes_);
  gl::check_errors("developing the picture");
}

void Renderer::develop(const View& view) {
  composite(view, view.show == Show::radiance ? kToneMapped : kSrgb);
}

image::Image Renderer::render(const View& view, int width, int height, int samples,
                              bool tone_mapped) {
  draw(view, width, height, samples);
  const gl::Target composed(float_format_, width, height, false, 1);
  composed.bind();
  composite(view, tone_mapped ? kToneMappedLinear : kLinear);
  image::Image upside_down(width, height, 4), image(width, height, 4);
  composed.read(upside_down.pixels);
  for (int y = 0; y < height; ++y)
    std::copy_n(upside_down.at(0, height - 1 - y), 4 * width, image.at(0, y));
  return image;
}

}  // namespace prt::runtime
