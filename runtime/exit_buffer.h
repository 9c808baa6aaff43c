// Exit values of all vertices, kept on the GPU while the light stays: they depend on the light, not
// on the eye. When the light has changed a vertex shader sums them, once for each vertex, and its
// outputs are captured, colour by colour, as OpenGL promises no more than 16 vec4 at once; every
// frame then fetches them, however often it shades a vertex.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "gl/objects.h"
#include "gl/program.h"
#include "runtime/exit_stage.h"

namespace prt::runtime {

class ExitBuffer {
 public:
  /// `places`: for each vertex, which of the captured ones it is. `exit` must outlive this.
  ExitBuffer(const ExitStage& exit, std::span<const std::uint32_t> places, std::size_t index_count,
             const gl::Buffer& positions, const gl::Buffer& indices);

  /// Whether this OpenGL can capture and keep exit values of so many vertices.
  static bool fits(const ExitLayout& layout, std::size_t vertex_count);
  /// A program whose vertex shader hands its exit values to send_exit.glsl, for fill(); among the
  /// defines are ExitStage::capture_defines.
  static gl::Program capturing(const char* vertex_shader, const gl::Defines& defines);

  /// The light has changed.
  void outdate() { is_current_ = false; }
  bool is_current() const { return is_current_; }
  /// Takes room for the values when first called, before anything is bound. False where OpenGL has
  /// none, with a warning the first time; they are then to be summed in every frame.
  [[nodiscard]] bool make_room();
  /// After make_room(). `draw_points` draws every vertex as a point, in the order of places, with a
  /// capturing program that is in use; for each colour.
  void fill(const std::function<void(int color)>& draw_points);
  /// After fill().
  void draw(const Viewpoint& viewpoint) const;

 private:
  std::size_t color_size() const;

  const ExitStage& exit_;
  std::size_t vertex_count_, index_count_;
  gl::Buffer places_;
  gl::VertexArray array_;
  gl::Program program_;
  gl::Buffer captured_;  // one colour
  gl::Table table_;      // colour by colour, each from the start of a row, vertex by vertex
  bool is_current_ = false;
  bool has_no_room_ = false;
};

}  // namespace prt::runtime
