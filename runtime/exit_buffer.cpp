#include "runtime/exit_buffer.h"

#include "core/error.h"
#include "core/log.h"

namespace prt::runtime {

namespace {

constexpr unsigned int kPlaceLocation = 1;

/// Rounded up to full rows of a table.
std::size_t in_rows(std::size_t count) {
  constexpr std::size_t kRow = gl::Table::kRowLength;
  return (count + kRow - 1) / kRow * kRow;
}

}  // namespace

bool ExitBuffer::fits(const ExitLayout& layout, std::size_t vertex_count) {
  const std::size_t vectors = layout.color_vector_count();
  return static_cast<int>(vectors) <= gl::limits().max_captured_vectors &&
         gl::Table::fits(layout.color_count() * in_rows(vertex_count * vectors));
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

bool ExitBuffer::make_room() {
  if (has_no_room_ || table_.count() > 0) return !has_no_room_;
  try {
    captured_ = gl::Buffer(color_size() * sizeof(Vec4));
    table_ = gl::Table(exit_.layout().color_count() * in_rows(color_size()));
  } catch (const Error& error) {
    log::warning("no room to keep what {} vertices send, which is summed in every frame: {}",
                 vertex_count_, error.what());
    captured_ = gl::Buffer();
    has_no_room_ = true;
    return false;
  }
  program_ = gl::Program("transfer_kept.vert", exit_.fragment_shader(), exit_.defines());
  return true;
}

void ExitBuffer::fill(const std::function<void(int color)>& draw_points) {
  for (std::size_t color = 0; color < exit_.layout().color_count(); ++color) {
    {
      const gl::Capture capture(captured_, 0, color_size() * sizeof(Vec4));
      draw_points(static_cast<int>(color));
    }
    table_.upload(captured_, color * in_rows(color_size()), color_size());
  }
  is_current_ = true;
}

void ExitBuffer::draw(const Viewpoint& viewpoint) const {
  const auto size = static_cast<int>(in_rows(color_size()));
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
