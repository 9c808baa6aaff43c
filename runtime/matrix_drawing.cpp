#include <epoxy/gl.h>
#include <fmt/format.h>

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
      array_(array_with_positions(positions, indices)),
      light_(static_cast<std::size_t>(band_count_ * band_count_)) {
  exit.attach(array_);
  const std::vector<Vec4> columns = columns_of(*model.signal, exit.layout());
  transfer_ = gl::Table(columns.size());
  transfer_.upload(columns);
  for (const bool varies : {false, true}) {
    gl::Defines defines = exit.defines();
    const gl::Defines light_defines = light_.defines(varies);
    defines.insert(defines.end(), light_defines.begin(), light_defines.end());
    defines.push_back(fmt::format("CHANNEL_COUNT {}", model.signal->channel_count));
    programs_[varies] = gl::Program("transfer_matrix.vert", exit.fragment_shader(), defines);
  }
}

void MatrixDrawing::set_light(const LightField& field) {
  light_.set(field, [&](const sh::Light& sample, Vec4* vectors) {
    const sh::Light fitted = sh::with_band_count(sample, band_count_);
    for (std::size_t i = 0; i < fitted.coefficients[0].size(); ++i)
      vectors[i] = Vec4(fitted.coefficients[0][i], fitted.coefficients[1][i],
                        fitted.coefficients[2][i], 0.0f);
  });
}

void MatrixDrawing::draw(const Viewpoint& viewpoint) const {
  const gl::Program& program = programs_[light_.varies()];
  program.use();
  exit_.bind(program, viewpoint);
  program.set("u_transfer", 0);
  transfer_.bind(0);
  light_.bind(program);
  array_.bind();
  draw_passes(exit_.layout().pass_count, [&](int pass) {
    program.set("u_pass", pass);
    draw_triangles(0, index_count_);
  });
}

}  // namespace prt::runtime
