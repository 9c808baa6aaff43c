#include <fmt/format.h>

#include "core/error.h"
#include "gl/context.h"
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
      array_(array_with_positions(positions, indices)) {
  const std::size_t vectors = vector_count(band_count_);
  if (3 * vectors > static_cast<std::size_t>(free_uniform_vectors(gl::limits())))
    throw_failed("this OpenGL has too few uniforms to draw uncompressed transfer",
                 {.found = fmt::format("{} bands", band_count_)});
  const std::vector<Vec4> padded = padded_transfer(*model.signal);
  transfer_ = gl::Table(padded.size());
  transfer_.upload(padded);
  program_ = gl::Program("transfer_uncompressed.vert", "radiance.frag",
                         {fmt::format("CHANNEL_COUNT {}", model.signal->channel_count),
                          fmt::format("VECTOR_COUNT {}", vectors)});
  light_.assign(3 * vectors, Vec4(0.0f));
}

void UncompressedDrawing::set_light(const sh::Light& light) {
  const sh::Light fitted = sh::with_band_count(light, band_count_);
  const std::size_t vectors = light_.size() / 3;
  for (std::size_t color = 0; color < 3; ++color)
    for (std::size_t k = 0; k < fitted.coefficients[color].size(); ++k)
      light_[color * vectors + k / 4][static_cast<int>(k % 4)] = fitted.coefficients[color][k];
}

void UncompressedDrawing::draw(const Viewpoint& viewpoint) const {
  program_.use();
  program_.set("u_clip_from_world", viewpoint.clip_from_world);
  program_.set("u_transfer", 0);
  program_.set("u_light", light_);
  transfer_.bind(0);
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
