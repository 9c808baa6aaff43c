#include <fmt/format.h>

#include "runtime/draw_calls.h"
#include "runtime/model_drawing.h"

namespace prt::runtime {

namespace {

std::size_t vector_count(int band_count) {
  return static_cast<std::size_t>(band_count * band_count + 3) / 4;
}

/// Coefficients in fours, zero padded at the end of each channel.
std::vector<Vec4> padded_transfer(const signal::TransferSignal& signal) {
  const auto coefficients = static_cast<std::size_t>(signal.band_count * signal.band_count);
  const std::size_t vectors = vector_count(signal.band_count);
  const std::size_t row_count =
      signal.vertex_count() * static_cast<std::size_t>(signal.channel_count);
  std::vector<Vec4> padded(row_count * vectors, Vec4(0.0f));
  for (std::size_t row = 0; row < row_count; ++row)
    for (std::size_t k = 0; k < coefficients; ++k)
      padded[row * vectors + k / 4][static_cast<int>(k % 4)] =
          signal.values[row * coefficients + k];
  return padded;
}

}  // namespace

UncompressedDrawing::UncompressedDrawing(const Model& model, const gl::Buffer& positions,
                                         const gl::Buffer& indices)
    : index_count_(model.indices.size()),
      band_count_(model.signal->band_count),
      array_(array_with_positions(positions, indices)),
      light_(3 * vector_count(band_count_)) {
  const std::vector<Vec4> padded = padded_transfer(*model.signal);
  transfer_ = gl::Table(padded.size());
  transfer_.upload(padded);
  for (const bool varies : {false, true}) {
    gl::Defines defines = light_.defines(varies);
    defines.push_back(fmt::format("CHANNEL_COUNT {}", model.signal->channel_count));
    defines.push_back(fmt::format("VECTOR_COUNT {}", vector_count(band_count_)));
    programs_[varies] = gl::Program("transfer_uncompressed.vert", "radiance.frag", defines);
  }
}

void UncompressedDrawing::set_light(const LightField& field) {
  light_.set(field, [&](const sh::Light& sample, Vec4* vectors) {
    const sh::Light fitted = sh::with_band_count(sample, band_count_);
    for (std::size_t color = 0; color < 3; ++color, vectors += vector_count(band_count_))
      for (std::size_t k = 0; k < fitted.coefficients[color].size(); ++k)
        vectors[k / 4][static_cast<int>(k % 4)] = fitted.coefficients[color][k];
  });
}

void UncompressedDrawing::draw(const Viewpoint& viewpoint) const {
  const gl::Program& program = programs_[light_.varies()];
  program.use();
  program.set("u_clip_from_world", viewpoint.clip_from_world);
  program.set("u_transfer", 0);
  transfer_.bind(0);
  light_.bind(program);
  array_.bind();
  draw_triangles(0, index_count_);
}

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
