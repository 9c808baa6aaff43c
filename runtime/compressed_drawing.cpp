#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "gl/context.h"
#include "runtime/cluster_chunks.h"
#include "runtime/draw_calls.h"
#include "runtime/model_drawing.h"

namespace prt::runtime {

namespace {

constexpr unsigned int kClusterLocation = 1, kFirstWeightLocation = 2;

/// The attributes and the unrolled loop that transfer_*.vert expect: GLSL cannot index attributes.
gl::Defines weight_defines(int component_count) {
  std::string inputs, loop;
  for (int i = 0; i < component_count; ++i) {
    if (i % 4 == 0)
      inputs += fmt::format("layout(location = {}) in vec4 a_weights_{}; ",
                            kFirstWeightLocation + static_cast<unsigned int>(i) / 4, i / 4);
    loop += fmt::format("F({}, a_weights_{}.{}) ", i, i / 4, "xyzw"[i % 4]);
  }
  return {fmt::format("COMPONENT_COUNT {}", component_count), "WEIGHT_INPUTS " + inputs,
          "FOR_EACH_WEIGHT(F) " + loop};
}

/// Weights in fours, zero padded.
std::vector<float> padded_weights(const cpca::Encoding& encoding) {
  const auto components = static_cast<std::size_t>(encoding.component_count);
  const std::size_t stride = (components + 3) / 4 * 4;
  std::vector<float> padded(encoding.point_count * stride, 0.0f);
  for (std::size_t p = 0; p < encoding.point_count; ++p)
    std::copy_n(encoding.weights.begin() + static_cast<std::ptrdiff_t>(p * components), components,
                padded.begin() + static_cast<std::ptrdiff_t>(p * stride));
  return padded;
}

void check_limits(int component_count) {
  const gl::Limits limits = gl::limits();
  const int by_attributes =
      4 * (limits.max_vertex_attributes - static_cast<int>(kFirstWeightLocation));
  const int by_uniforms = limits.max_vertex_uniform_vectors - 8;  // the others of the shader
  const int most = std::min(by_attributes, by_uniforms);
  if (component_count > most)
    throw_failed("this OpenGL has too few vertex attributes for the model",
                 {.found = fmt::format("{} components", component_count),
                  .expected = fmt::format("at most {}", most),
                  .advice = "Compress with fewer components."});
}

gl::VertexArray make_array(int component_count, const gl::Buffer& positions,
                           const gl::Buffer& clusters, const gl::Buffer& weights,
                           const gl::Buffer& indices) {
  gl::VertexArray array = array_with_positions(positions, indices);
  array.set_uints(kClusterLocation, clusters);
  const auto vectors = static_cast<std::size_t>((component_count + 3) / 4);
  for (std::size_t i = 0; i < vectors; ++i)
    array.set_floats(kFirstWeightLocation + static_cast<unsigned int>(i), weights, 4,
                     vectors * sizeof(Vec4), i * sizeof(Vec4));
  return array;
}

}  // namespace

CompressedDrawing::CompressedDrawing(const Model& model, const gl::Buffer& positions,
                                     const gl::Buffer& indices)
    : index_count_(model.indices.size()),
      component_count_(model.transfer->encoding.component_count) {
  check_limits(component_count_);
  const cpca::Encoding& encoding = model.transfer->encoding;
  const ClusterChunks chunks =
      make_cluster_chunks(model.indices, encoding.cluster_of_point, encoding.cluster_count);
  chunk_offsets_ = chunks.chunk_offsets;
  clusters_ = gl::Buffer(std::span(encoding.cluster_of_point));
  weights_ = gl::Buffer(std::span<const float>(padded_weights(encoding)));
  chunk_indices_ = gl::Buffer(std::span(chunks.indices));
  single_array_ = make_array(component_count_, positions, clusters_, weights_, indices);
  chunk_array_ = make_array(component_count_, positions, clusters_, weights_, chunk_indices_);
  const gl::Defines defines = weight_defines(component_count_);
  single_program_ = gl::Program("transfer_single.vert", "radiance.frag", defines);
  cluster_program_ = gl::Program("transfer_cluster.vert", "radiance.frag", defines);
  depth_program_ = gl::Program("depth.vert", "depth.frag");
  constant_table_ = gl::Table(static_cast<std::size_t>(encoding.cluster_count) *
                              static_cast<std::size_t>(component_count_ + 1));
}

void CompressedDrawing::set_constants(const std::vector<Vec4>& constants) {
  constants_ = constants;
  constant_table_.upload(constants_);
}

void CompressedDrawing::draw_single(const Matrix4& clip_from_world) const {
  single_program_.use();
  single_program_.set("u_clip_from_world", clip_from_world);
  single_program_.set("u_constants", 0);
  constant_table_.bind(0);
  single_array_.bind();
  draw_triangles(0, index_count_);
}

void CompressedDrawing::draw_clusters(const Matrix4& clip_from_world) const {
  depth_program_.use();
  depth_program_.set("u_clip_from_world", clip_from_world);
  single_array_.bind();
  draw_triangles(0, index_count_);

  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);  // the first pass has set the coverage
  cluster_program_.use();
  cluster_program_.set("u_clip_from_world", clip_from_world);
  const int cluster_location = cluster_program_.location("u_cluster");
  const int constants_location = cluster_program_.location("u_constants");
  chunk_array_.bind();
  const auto constant_count = static_cast<std::size_t>(component_count_) + 1;
  for (std::size_t cluster = 0; cluster + 1 < chunk_offsets_.size(); ++cluster) {
    const std::size_t count = chunk_offsets_[cluster + 1] - chunk_offsets_[cluster];
    if (count == 0) continue;
    glUniform1i(cluster_location, static_cast<GLint>(cluster));
    glUniform4fv(constants_location, static_cast<GLsizei>(constant_count),
                 &constants_[cluster * constant_count].x);
    draw_triangles(chunk_offsets_[cluster], count);
  }
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
}

}  // namespace prt::runtime
