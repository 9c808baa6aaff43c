#include "runtime/exit_buffer.h"

#include <utility>

namespace prt::runtime {

namespace {

constexpr unsigned int kPlaceLocation = 1;

}  // namespace

bool ExitBuffer::fits(const ExitLayout& layout, std::size_t vertex_count) {
  const std::size_t vectors = layout.color_vector_count();
  return static_cast<int>(vectors) <= gl::limits().max_captured_vectors &&
         gl::Table::fits(vertex_count * layout.color_count() * vectors);
}

gl::Program ExitBuffer::capturing(const char* vertex_shader, const gl::Defines& defines) {
  return gl::Program(vertex_shader, "black.frag", defines, "v_exit");
}

ExitBuffer::ExitBuffer(const ExitStage& exit, std::span<const std::uint32_t> places,
                       std::size_t index_count, const gl::Buffer& positions,
                       const gl::Buffer& indices)
    : exit_(exit),
      vertex_count_(places.size()),
      index_count_(index_count),
      places_(places),
      array_(array_with_positions(positions, indices)) {
  array_.set_uints(kPlaceLocation, places_);
  exit.attach(array_);
}

/// In vec4.
std::size_t ExitBuffer::color_size() const {
  return vertex_count_ * exit_.layout().color_vector_count();
}

void ExitBuffer::fill(const std::function<void(int color)>& draw_points) {
  const std::size_t color_count = exit_.layout().color_count(), count = color_count * color_size();
  const bool is_first = table_.count() != count;
  if (is_first) {
    captured_ = gl::Buffer(count * sizeof(Vec4));
    program_ = gl::Program("transfer_kept.vert", exit_.fragment_shader(), exit_.defines());
  }
  for (std::size_t color = 0; color < color_count; ++color) {
    const std::size_t byte_count = color_size() * sizeof(Vec4);
    const gl::Capture capture(captured_, color * byte_count, byte_count);
    draw_points(static_cast<int>(color));
  }
  if (is_first) table_ = gl::Table(count);  // not before: it is bound, where a source may be
  table_.upload(captured_);
  is_current_ = true;
}

void ExitBuffer::draw(const Viewpoint& viewpoint) const {
  const auto size = static_cast<int>(color_size());
  program_.use();
  exit_.bind(program_, viewpoint);
  program_.set("u_exit", 0);
  program_.set("u_color_size", size);
  table_.bind(0);
  array_.bind();
  draw_passes(exit_.layout().pass_count, [&](int pass) {
    program_.set("u_first", pass * size);
    draw_triangles(0, index_count_);
  });
}

}  // namespace prt::runtime
