#include <epoxy/gl.h>
#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel.h"
#include "runtime/model_drawing.h"

namespace prt::runtime {

namespace {

/// Matrices as transfer_matrix.vert reads them: for each vertex, channel and source coefficient a
/// column of exit coefficients by slot.
std::vector<Vec4> columns_of(const signal::TransferSignal& signal, const ExitLayout& layout) {
  const auto coefficients = static_cast<std::size_t>(signal.band_count * signal.band_count);
  const auto rows = static_cast<std::size_t>(signal.row_count);
  const std::size_t vectors = layout.color_vector_count();
  const std::size_t matrix_count =
      signal.vertex_count() * static_cast<std::size_t>(signal.channel_count);
  std::vector<Vec4> columns(matrix_count * coefficients * vectors, Vec4(0.0f));
  parallel_for(matrix_count, 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t matrix = begin; matrix < end; ++matrix)
      for (std::size_t slot = 0; slot < rows; ++slot) {
        const auto row = static_cast<std::size_t>(layout.row_of_slot[slot]);
        for (std::size_t i = 0; i < coefficients; ++i)
          columns[(matrix * coefficients + i) * vectors + slot / 4][static_cast<int>(slot % 4)] =
              signal.values[(matrix * rows + row) * coefficients + i];
      }
  });
  return columns;
}

}  // namespace

MatrixDrawing::MatrixDrawing(const Model& model, const ExitStage& exit, const gl::Buffer& positions,
                             const gl::Buffer& indices)
    : exit_(exit),
      index_count_(model.indices.size()),
      band_count_(model.signal->band_count),
      channel_count_(model.signal->channel_count),
      array_(array_with_positions(positions, indices)) {
  const int coefficients = band_count_ * band_count_;
  if (coefficients > free_uniform_vectors(gl::limits()))
    throw_failed("this OpenGL has too few uniforms to draw uncompressed transfer",
                 {.found = fmt::format("{} bands", band_count_)});
  exit.attach(array_);
  const std::vector<Vec4> columns = columns_of(*model.signal, exit.layout());
  transfer_ = gl::Table(columns.size());
  transfer_.upload(columns);
  gl::Defines defines = exit.defines();
  defines.insert(defines.end(), {fmt::format("CHANNEL_COUNT {}", channel_count_),
                                 fmt::format("COEFFICIENT_COUNT {}", coefficients)});
  program_ = gl::Program("transfer_matrix.vert", exit.fragment_shader(), defines);
  light_.assign(static_cast<std::size_t>(coefficients), Vec4(0.0f));
}

void MatrixDrawing::set_light(const sh::Light& light) {
  const sh::Light fitted = sh::with_band_count(light, band_count_);
  for (std::size_t i = 0; i < light_.size(); ++i)
    light_[i] =
        Vec4(fitted.coefficients[0][i], fitted.coefficients[1][i], fitted.coefficients[2][i], 0.0f);
}

void MatrixDrawing::draw(const Viewpoint& viewpoint) const {
  program_.use();
  exit_.bind(program_, viewpoint);
  program_.set("u_transfer", 0);
  program_.set("u_light", light_);
  transfer_.bind(0);
  array_.bind();
  draw_passes(exit_.layout().pass_count, true, [&](int pass) {
    if (pass > 0) glClear(GL_DEPTH_BUFFER_BIT);  // every pass decides anew, and alike
    program_.set("u_pass", pass);
    draw_triangles(0, index_count_);
  });
}

}  // namespace prt::runtime
