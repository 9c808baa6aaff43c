#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "cpca/superclusters.h"
#include "gl/context.h"
#include "runtime/cluster_chunks.h"
#include "runtime/model_drawing.h"

namespace prt::runtime {

namespace {

/// Constants, M_i l or t_i·l, that fit the uniforms of a draw call.
std::size_t constant_limit(const ExitLayout& layout) {
  return static_cast<std::size_t>(free_uniform_vectors(gl::limits())) / layout.pass_vector_count();
}

void check_uniforms(const cpca::Encoding& encoding, const ExitLayout& layout) {
  const int most = static_cast<int>(constant_limit(layout)) - 1;
  if (encoding.component_count > most)
    throw_failed("this OpenGL has too few uniforms for the model",
                 {.found = fmt::format("{} components", encoding.component_count),
                  .expected = fmt::format("at most {}", most),
                  .advice = "Compress with fewer components."});
}

std::vector<std::uint32_t> constants_of_vertices(const cpca::Encoding& encoding) {
  const std::vector<std::uint32_t> first = first_constants(encoding);
  std::vector<std::uint32_t> constants;
  for (const std::uint32_t cluster : encoding.cluster_of_point) constants.push_back(first[cluster]);
  return constants;
}

}  // namespace

gl::VertexArray CompressedDrawing::make_array(const gl::Buffer& positions,
                                              const gl::Buffer& indices) const {
  gl::VertexArray array = array_with_positions(positions, indices);
  array.set_uints(kConstantsLocation, constants_of_vertices_);
  weights_.attach(array);
  exit_.attach(array);
  return array;
}

CompressedDrawing::CompressedDrawing(const Model& model, const ExitStage& exit,
                                     const gl::Buffer& positions, const gl::Buffer& indices,
                                     bool keep_sums)
    : exit_(exit),
      index_count_(model.indices.size()),
      constant_count_(first_constants(model.transfer->encoding).back()),
      products_(*model.transfer, exit.layout()),
      weights_(model.transfer->encoding, model.transfer->weight_format, exit.end_location()) {
  const cpca::Encoding& encoding = model.transfer->encoding;
  check_uniforms(encoding, exit.layout());
  constants_of_vertices_ =
      gl::Buffer(std::span<const std::uint32_t>(constants_of_vertices(encoding)));
  single_array_ = make_array(positions, indices);
  make_chunks(model, positions);
  make_programs();
  if (keep_sums) sums_.emplace(model, exit, positions, indices);
}

void CompressedDrawing::make_chunks(const Model& model, const gl::Buffer& positions) {
  const cpca::Encoding& encoding = model.transfer->encoding;
  const std::vector<std::uint32_t> first_clusters =
      first_clusters_of_chunks(*model.transfer, constant_limit(exit_.layout()));
  const ClusterChunks chunks =
      make_cluster_chunks(model.indices, cpca::superclusters_of_points(encoding, first_clusters),
                          first_clusters.size());
  chunk_offsets_ = chunks.chunk_offsets;
  const std::vector<std::uint32_t> constants = first_constants(encoding);
  for (const std::uint32_t cluster : first_clusters) chunk_constants_.push_back(constants[cluster]);
  chunk_constants_.push_back(constants.back());
  chunk_indices_ = gl::Buffer(std::span(chunks.indices));
  chunk_array_ = make_array(positions, chunk_indices_);
}

void CompressedDrawing::make_programs() {
  std::uint32_t most_constants = 0;
  for (std::size_t i = 0; i + 1 < chunk_constants_.size(); ++i)
    most_constants = std::max(most_constants, chunk_constants_[i + 1] - chunk_constants_[i]);
  const gl::Defines defines = gl::joined({weights_.defines(), exit_.defines()});
  const gl::Defines constant_count{fmt::format("CONSTANT_COUNT {}", most_constants)};
  const char* const pixels = exit_.fragment_shader();
  single_programs_ = LightPrograms([=](bool varies) {
    return gl::Program("transfer_single.vert", pixels,
                       gl::joined({light_field_defines(varies), defines}));
  });
  cluster_programs_ = LightPrograms([=](bool varies) {
    return gl::Program("transfer_cluster.vert", pixels,
                       gl::joined({light_field_defines(varies), defines, constant_count}));
  });
}

void CompressedDrawing::set_light(const LightField& field) {
  if (sums_) sums_->outdate();
  grid_ = field.grid;
  constants_.clear();
  for (const sh::Light& sample : field.samples) {
    const std::vector<Vec4>& products = products_.evaluate(sample);
    constants_.insert(constants_.end(), products.begin(), products.end());
  }
  if (constant_table_.count() != constants_.size()) constant_table_ = gl::Table(constants_.size());
  constant_table_.upload(constants_);
}

void CompressedDrawing::bind(const gl::Program& program, const Viewpoint& viewpoint) const {
  program.use();
  exit_.bind(program, viewpoint);
  weights_.bind(program);
  grid_.bind(program);
}

void CompressedDrawing::draw_single(const Viewpoint& viewpoint) const {
  const gl::Program& program = single_programs_.of(grid_.size > 1);
  const int pass_count = exit_.layout().pass_count;
  bind(program, viewpoint);
  program.set("u_constants", 0);
  program.set("u_sample_size", pass_count * static_cast<int>(constant_count_));
  constant_table_.bind(0);
  single_array_.bind();
  draw_passes(pass_count, [&](int pass) {
    program.set("u_first_vector",
                pass * static_cast<int>(constant_count_ * exit_.layout().pass_vector_count()));
    draw_triangles(0, index_count_);
  });
}

bool CompressedDrawing::sum() {
  if (!sums_ || !sums_->make_room()) return false;
  if (!sums_->is_current()) sums_->fill(grid_, constants_, constant_table_);
  return true;
}

bool CompressedDrawing::draw_kept(const Viewpoint& viewpoint) {
  if (!sum()) return false;
  sums_->draw(viewpoint);
  return true;
}

void CompressedDrawing::draw_clusters(const Viewpoint& viewpoint) const {
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_ONE, GL_ONE, GL_ZERO, GL_ONE);  // coverage stays
  const gl::Program& program = cluster_programs_.of(grid_.size > 1);
  bind(program, viewpoint);
  chunk_array_.bind();
  const std::size_t pass_size = constant_count_ * exit_.layout().pass_vector_count();
  const auto pass_count = static_cast<std::size_t>(exit_.layout().pass_count);
  draw_passes(exit_.layout().pass_count, [&](int pass) {
    for (std::size_t sample = 0; sample < grid_.point_count(); ++sample) {
      program.set("u_light_sample", grid_.place(sample));
      draw_chunks(program,
                  &constants_[(sample * pass_count + static_cast<std::size_t>(pass)) * pass_size]);
    }
  });
  glDisable(GL_BLEND);
}

void CompressedDrawing::draw_chunks(const gl::Program& program, const Vec4* constants) const {
  const int first_location = program.location("u_first_constant");
  const int count_location = program.location("u_constant_count");
  const int constants_location = program.location("u_constants");
  const std::size_t vectors = exit_.layout().pass_vector_count();
  for (std::size_t chunk = 0; chunk + 1 < chunk_offsets_.size(); ++chunk) {
    const std::size_t index_count = chunk_offsets_[chunk + 1] - chunk_offsets_[chunk];
    if (index_count == 0) continue;
    const std::uint32_t first = chunk_constants_[chunk];
    const std::uint32_t count = chunk_constants_[chunk + 1] - first;
    glUniform1i(first_location, static_cast<GLint>(first));
    glUniform1i(count_location, static_cast<GLint>(count));
    glUniform4fv(constants_location, static_cast<GLsizei>(count * vectors),
                 &constants[first * vectors].x);
    draw_triangles(chunk_offsets_[chunk], index_count);
  }
}

}  // namespace prt::runtime
