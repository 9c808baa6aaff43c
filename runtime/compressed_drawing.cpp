#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "cpca/superclusters.h"
#include "gl/context.h"
#include "runtime/cluster_chunks.h"
#include "runtime/cluster_constants.h"
#include "runtime/model_drawing.h"

namespace prt::runtime {

namespace {

constexpr unsigned int kConstantsLocation = 1;

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
                                     const gl::Buffer& positions, const gl::Buffer& indices)
    : exit_(exit),
      index_count_(model.indices.size()),
      weights_(model.transfer->encoding, exit.end_location()) {
  const cpca::Encoding& encoding = model.transfer->encoding;
  check_uniforms(encoding, exit.layout());
  constant_count_ = first_constants(encoding).back();
  constants_of_vertices_ =
      gl::Buffer(std::span<const std::uint32_t>(constants_of_vertices(encoding)));
  single_array_ = make_array(positions, indices);
  make_chunks(model, positions);
  std::uint32_t most_constants = 0;
  for (std::size_t i = 0; i + 1 < chunk_constants_.size(); ++i)
    most_constants = std::max(most_constants, chunk_constants_[i + 1] - chunk_constants_[i]);
  gl::Defines defines = weights_.defines();
  const gl::Defines exit_defines = exit.defines();
  defines.insert(defines.end(), exit_defines.begin(), exit_defines.end());
  single_program_ = gl::Program("transfer_single.vert", exit.fragment_shader(), defines);
  defines.push_back(fmt::format("CONSTANT_COUNT {}", most_constants));
  cluster_program_ = gl::Program("transfer_cluster.vert", exit.fragment_shader(), defines);
  depth_program_ = gl::Program("depth.vert", "depth.frag");
  constant_table_ = gl::Table(constant_count_ * static_cast<std::size_t>(exit.layout().pass_count) *
                              exit.layout().pass_vector_count());
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

void CompressedDrawing::set_constants(const std::vector<Vec4>& constants) {
  constants_ = constants;
  constant_table_.upload(constants_);
}

void CompressedDrawing::draw_single(const Viewpoint& viewpoint) const {
  single_program_.use();
  exit_.bind(single_program_, viewpoint);
  single_program_.set("u_constants", 0);
  constant_table_.bind(0);
  weights_.bind(single_program_);
  single_array_.bind();
  draw_passes(exit_.layout().pass_count, true, [&](int pass) {
    if (pass > 0) glClear(GL_DEPTH_BUFFER_BIT);  // every pass decides anew, and alike
    single_program_.set("u_first_constant", pass * static_cast<int>(constant_count_));
    draw_triangles(0, index_count_);
  });
}

void CompressedDrawing::draw_clusters(const Viewpoint& viewpoint) const {
  depth_program_.use();
  depth_program_.set("u_clip_from_world", viewpoint.clip_from_world);
  single_array_.bind();
  draw_triangles(0, index_count_);

  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  cluster_program_.use();
  exit_.bind(cluster_program_, viewpoint);
  weights_.bind(cluster_program_);
  chunk_array_.bind();
  // The first draw has set the coverage.
  draw_passes(exit_.layout().pass_count, false, [&](int pass) { draw_chunks(pass); });
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
}

void CompressedDrawing::draw_chunks(int pass) const {
  const int first_location = cluster_program_.location("u_first_constant");
  const int count_location = cluster_program_.location("u_constant_count");
  const int constants_location = cluster_program_.location("u_constants");
  const std::size_t vectors = exit_.layout().pass_vector_count();
  const Vec4* const constants =
      constants_.data() + static_cast<std::size_t>(pass) * constant_count_ * vectors;
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
