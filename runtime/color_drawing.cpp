#include "runtime/draw_calls.h"
#include "runtime/model_drawing.h"

namespace prt::runtime {

BlackDrawing::BlackDrawing(std::size_t index_count, const gl::Buffer& positions,
                           const gl::Buffer& indices)
    : index_count_(index_count),
      array_(array_with_positions(positions, indices)),
      program_("black.vert", "black.frag") {}

void BlackDrawing::draw(const Viewpoint& viewpoint) const {
  program_.use();
  program_.set("u_clip_from_world", viewpoint.clip_from_world);
  array_.bind();
  draw_triangles(0, index_count_);
}

ColorDrawing::ColorDrawing(std::span<const Vec3> colors, std::size_t index_count,
                           const gl::Buffer& positions, const gl::Buffer& indices)
    : index_count_(index_count),
      colors_(colors),
      array_(array_with_positions(positions, indices)),
      program_("vertex_color.vert", "vertex_color.frag") {
  array_.set_floats(1, colors_, 3, sizeof(Vec3), 0);
}

void ColorDrawing::draw(const Viewpoint& viewpoint) const {
  program_.use();
  program_.set("u_clip_from_world", viewpoint.clip_from_world);
  array_.bind();
  draw_triangles(0, index_count_);
}

}  // namespace prt::runtime
