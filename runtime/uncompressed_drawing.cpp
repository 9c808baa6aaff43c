#include <fmt/format.h>

#include <numeric>

#include "core/parallel.h"
#include "runtime/model_drawing.h"
#include "sh/basis.h"

namespace prt::runtime {

namespace {

std::size_t coefficient_count(const signal::TransferSignal& signal) {
  return sh::row_size(signal.band_count);
}

std::size_t row_vector_count(int band_count) { return (sh::row_size(band_count) + 3) / 4; }

/// vec4 of a sample of the light: of glossy transfer (R, G, B, 0) for each coefficient; of diffuse
/// transfer coefficients in fours, colour by colour.
std::size_t light_vector_count(int band_count, bool is_glossy) {
  return is_glossy ? sh::row_size(band_count) : 3 * row_vector_count(band_count);
}

/// Diffuse transfer as transfer_uncompressed.vert reads it: coefficients in fours, zero padded at
/// the end of each channel.
std::vector<Vec4> padded_rows(const signal::TransferSignal& signal) {
  const std::size_t coefficients = coefficient_count(signal);
  const std::size_t vectors = row_vector_count(signal.band_count);
  const std::size_t row_count =
      signal.vertex_count() * static_cast<std::size_t>(signal.channel_count);
  std::vector<Vec4> padded(row_count * vectors, Vec4(0.0f));
  for (std::size_t row = 0; row < row_count; ++row)
    for (std::size_t k = 0; k < coefficients; ++k)
      padded[row * vectors + k / 4][static_cast<int>(k % 4)] =
          signal.values[row * coefficients + k];
  return padded;
}

/// Matrices as transfer_matrix.vert reads them: for each vertex, channel and source coefficient a
/// column of exit coefficients by slot.
std::vector<Vec4> columns_of(const signal::TransferSignal& signal, const ExitLayout& layout) {
  const std::size_t coefficients = coefficient_count(signal);
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

/// Elements of the table that holds either.
std::size_t table_size(const signal::TransferSignal& signal, const ExitLayout& layout) {
  const std::size_t vectors = layout.is_glossy()
                                  ? coefficient_count(signal) * layout.color_vector_count()
                                  : row_vector_count(signal.band_count);
  return signal.vertex_count() * static_cast<std::size_t>(signal.channel_count) * vectors;
}

std::vector<std::uint32_t> numbers(std::size_t count) {
  std::vector<std::uint32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0u);
  return numbers;
}

}  // namespace

UncompressedDrawing::UncompressedDrawing(const Model& model, const ExitStage& exit,
                                         const gl::Buffer& positions, const gl::Buffer& indices,
                                         bool keep_sums)
    : exit_(exit),
      vertex_count_(model.positions.size()),
      index_count_(model.indices.size()),
      band_count_(model.signal->band_count),
      array_(array_with_positions(positions, indices)),
      transfer_(table_size(*model.signal, exit.layout())),
      light_(light_vector_count(band_count_, exit.layout().is_glossy())) {
  exit.attach(array_);
  if (keep_sums) kept_.emplace(exit, numbers(vertex_count_), index_count_, positions, indices);
  const bool is_glossy = exit.layout().is_glossy();
  transfer_.upload(is_glossy ? columns_of(*model.signal, exit.layout())
                             : padded_rows(*model.signal));
  const char* const shader = is_glossy ? "transfer_matrix.vert" : "transfer_uncompressed.vert";
  const gl::Defines sizes{fmt::format("CHANNEL_COUNT {}", model.signal->channel_count),
                          fmt::format("ROW_VECTOR_COUNT {}", row_vector_count(band_count_))};
  programs_ = LightPrograms([=, this](bool varies) {
    return gl::Program(shader, exit_.fragment_shader(),
                       gl::joined({exit_.defines(), light_.defines(varies), sizes}));
  });
  sum_programs_ = LightPrograms([=, this](bool varies) {
    return ExitBuffer::capturing(
        shader, gl::joined({exit_.capture_defines(), light_.defines(varies), sizes}));
  });
}

bool UncompressedDrawing::fits(const signal::TransferSignal& signal, const ExitLayout& layout) {
  return gl::Table::fits(table_size(signal, layout));
}

void UncompressedDrawing::set_light(const LightField& field) {
  if (kept_) kept_->outdate();
  light_.set(field, [&](const sh::Light& sample, Vec4* vectors) {
    const sh::Light fitted = sh::with_band_count(sample, band_count_);
    for (std::size_t color = 0; color < 3; ++color)
      for (std::size_t k = 0; k < fitted.coefficients[color].size(); ++k) {
        const float value = fitted.coefficients[color][k];
        if (exit_.layout().is_glossy())
          vectors[k][static_cast<int>(color)] = value;
        else
          vectors[color * row_vector_count(band_count_) + k / 4][static_cast<int>(k % 4)] = value;
      }
  });
}

void UncompressedDrawing::bind(const gl::Program& program) const {
  program.use();
  program.set("u_transfer", 0);
  transfer_.bind(0);
  light_.bind(program);
  array_.bind();
}

void UncompressedDrawing::draw(const Viewpoint& viewpoint) const {
  const gl::Program& program = programs_.of(light_.varies());
  bind(program);
  exit_.bind(program, viewpoint);
  draw_passes(exit_.layout().pass_count, [&](int pass) {
    program.set("u_pass", pass);
    draw_triangles(0, index_count_);
  });
}

bool UncompressedDrawing::sum() {
  if (!kept_ || !kept_->make_room()) return false;
  if (!kept_->is_current()) {
    const gl::Program& program = sum_programs_.of(light_.varies());
    bind(program);
    kept_->fill([&](int color) {
      program.set("u_pass", color);
      gl::draw_points(0, vertex_count_);
    });
  }
  return true;
}

bool UncompressedDrawing::draw_kept(const Viewpoint& viewpoint) {
  if (!sum()) return false;
  kept_->draw(viewpoint);
  return true;
}

}  // namespace prt::runtime
