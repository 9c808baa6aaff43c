#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "cpca/superclusters.h"
#include "gl/context.h"
#include "runtime/cluster_chunks.h"
#include "runtime/cluster_constants.h"
#include "runtime/draw_calls.h"
#include "runtime/model_drawing.h"

namespace prt::runtime {

namespace {

constexpr unsigned int kConstantsLocation = 1, kFirstWeightLocation = 2;

bool is_adaptive(const cpca::Encoding& encoding) { return !encoding.component_counts.empty(); }

/// What weights.glsl expects.
gl::Defines weight_defines(const cpca::Encoding& encoding) {
  if (is_adaptive(encoding)) return {"ADAPTIVE 1"};
  std::string inputs, loop;
  for (int i = 0; i < encoding.component_count; ++i) {
    if (i % 4 == 0)
      inputs += fmt::format("layout(location = {}) in vec4 a_weights_{}; ",
                            kFirstWeightLocation + static_cast<unsigned int>(i) / 4, i / 4);
    loop += fmt::format("F({}, a_weights_{}.{}) ", i, i / 4, "xyzw"[i % 4]);
  }
  return {"WEIGHT_INPUTS " + inputs, "FOR_EACH_WEIGHT(F) " + loop};
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

/// Weights that clusters have, point after point in one row of fours; and, two for each point, the
/// number of its first weight and how many they are.
struct PackedWeights {
  std::vector<Vec4> values;
  std::vector<std::uint32_t> ranges;
};

PackedWeights packed_weights(const cpca::Encoding& encoding) {
  PackedWeights packed;
  std::uint32_t count = 0;
  for (std::size_t p = 0; p < encoding.point_count; ++p) {
    const auto own = static_cast<std::uint32_t>(
        encoding.component_count_of(static_cast<int>(encoding.cluster_of_point[p])));
    packed.ranges.insert(packed.ranges.end(), {count, own});
    for (std::uint32_t i = 0; i < own; ++i, ++count) {
      if (count % 4 == 0) packed.values.emplace_back(0.0f);
      packed.values.back()[static_cast<int>(count % 4)] =
          encoding.weights[p * static_cast<std::size_t>(encoding.component_count) + i];
    }
  }
  return packed;
}

/// vec4 uniforms for the constants of a chunk.
std::size_t register_limit() {
  constexpr int kOtherUniforms = 8;  // of the shader
  return static_cast<std::size_t>(
      std::max(gl::limits().max_vertex_uniform_vectors - kOtherUniforms, 0));
}

void check_limits(const cpca::Encoding& encoding) {
  const int by_attributes =
      4 * (gl::limits().max_vertex_attributes - static_cast<int>(kFirstWeightLocation));
  const int by_uniforms = static_cast<int>(register_limit()) - 1;
  const int most = is_adaptive(encoding) ? by_uniforms : std::min(by_attributes, by_uniforms);
  if (encoding.component_count > most)
    throw_failed("this OpenGL has too few vertex attributes or uniforms for the model",
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
  if (weight_table_.width() > 0) {
    array.set_uints(kFirstWeightLocation, weight_ranges_, 2);
    return array;
  }
  for (int i = 0; i < weight_vector_count_; ++i)
    array.set_floats(kFirstWeightLocation + static_cast<unsigned int>(i), weights_, 4,
                     static_cast<std::size_t>(weight_vector_count_) * sizeof(Vec4),
                     static_cast<std::size_t>(i) * sizeof(Vec4));
  return array;
}

CompressedDrawing::CompressedDrawing(const Model& model, const gl::Buffer& positions,
                                     const gl::Buffer& indices)
    : index_count_(model.indices.size()),
      weight_vector_count_((model.transfer->encoding.component_count + 3) / 4) {
  const cpca::Encoding& encoding = model.transfer->encoding;
  check_limits(encoding);
  const std::vector<std::uint32_t> first_clusters =
      first_clusters_of_chunks(*model.transfer, register_limit());
  const ClusterChunks chunks =
      make_cluster_chunks(model.indices, cpca::superclusters_of_points(encoding, first_clusters),
                          first_clusters.size());
  chunk_offsets_ = chunks.chunk_offsets;
  const std::vector<std::uint32_t> constants = first_constants(encoding);
  for (const std::uint32_t cluster : first_clusters) chunk_constants_.push_back(constants[cluster]);
  chunk_constants_.push_back(constants.back());
  constants_of_vertices_ =
      gl::Buffer(std::span<const std::uint32_t>(constants_of_vertices(encoding)));
  chunk_indices_ = gl::Buffer(std::span(chunks.indices));
  if (is_adaptive(encoding)) {
    const PackedWeights packed = packed_weights(encoding);
    weight_ranges_ = gl::Buffer(std::span(packed.ranges));
    weight_table_ = gl::Table(packed.values.size());
    weight_table_.upload(packed.values);
  } else {
    weights_ = gl::Buffer(std::span<const float>(padded_weights(encoding)));
  }
  single_array_ = make_array(positions, indices);
  chunk_array_ = make_array(positions, chunk_indices_);
  std::uint32_t most_constants = 0;
  for (std::size_t i = 0; i < first_clusters.size(); ++i)
    most_constants = std::max(most_constants, chunk_constants_[i + 1] - chunk_constants_[i]);
  gl::Defines defines = weight_defines(encoding);
  single_program_ = gl::Program("transfer_single.vert", "radiance.frag", defines);
  defines.push_back(fmt::format("CONSTANT_COUNT {}", most_constants));
  cluster_program_ = gl::Program("transfer_cluster.vert", "radiance.frag", defines);
  depth_program_ = gl::Program("depth.vert", "depth.frag");
  constant_table_ = gl::Table(constants.back());
}

void CompressedDrawing::set_constants(const std::vector<Vec4>& constants) {
  constants_ = constants;
  constant_table_.upload(constants_);
}

void CompressedDrawing::bind_weights(const gl::Program& program) const {
  if (weight_table_.width() == 0) return;
  program.set("u_weights", 1);
  weight_table_.bind(1);
}

void CompressedDrawing::draw_single(const Matrix4& clip_from_world) const {
  single_program_.use();
  single_program_.set("u_clip_from_world", clip_from_world);
  single_program_.set("u_constants", 0);
  constant_table_.bind(0);
  bind_weights(single_program_);
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
  bind_weights(cluster_program_);
  const int first_location = cluster_program_.location("u_first_constant");
  const int count_location = cluster_program_.location("u_constant_count");
  const int constants_location = cluster_program_.location("u_constants");
  chunk_array_.bind();
  for (std::size_t chunk = 0; chunk + 1 < chunk_offsets_.size(); ++chunk) {
    const std::size_t index_count = chunk_offsets_[chunk + 1] - chunk_offsets_[chunk];
    if (index_count == 0) continue;
    const std::uint32_t first = chunk_constants_[chunk];
    const auto count = static_cast<GLsizei>(chunk_constants_[chunk + 1] - first);
    glUniform1i(first_location, static_cast<GLint>(first));
    glUniform1i(count_location, count);
    glUniform4fv(constants_location, count, &constants_[first].x);
    draw_triangles(chunk_offsets_[chunk], index_count);
  }
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
}

}  // namespace prt::runtime
