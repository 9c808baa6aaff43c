#include "runtime/cluster_sums.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "runtime/cluster_constants.h"

namespace prt::runtime {

namespace {

std::vector<std::uint32_t> places_of(const cpca::PointsByCluster& vertices) {
  std::vector<std::uint32_t> places(vertices.points.size());
  for (std::uint32_t place = 0; place < places.size(); ++place)
    places[vertices.points[place]] = place;
  return places;
}

/// What WeightInputs needs of an encoding, its points in another order.
cpca::Encoding with_points(const cpca::Encoding& encoding,
                           const std::vector<std::uint32_t>& points) {
  cpca::Encoding sorted;
  sorted.point_count = encoding.point_count;
  sorted.component_count = encoding.component_count;
  sorted.component_counts = encoding.component_counts;
  const auto components = static_cast<std::size_t>(encoding.component_count);
  for (const std::uint32_t p : points) {
    sorted.cluster_of_point.push_back(encoding.cluster_of_point[p]);
    const float* const weights = encoding.weights.data() + p * components;
    sorted.weights.insert(sorted.weights.end(), weights, weights + components);
  }
  return sorted;
}

}  // namespace

ClusterSums::ClusterSums(const Model& model, const ExitStage& exit, const gl::Buffer& positions,
                         const gl::Buffer& indices)
    : exit_(exit),
      vertices_(
          cpca::sort_by_cluster(model.transfer->encoding.cluster_of_point,
                                static_cast<std::size_t>(model.transfer->encoding.cluster_count))),
      first_constants_(first_constants(model.transfer->encoding)),
      weights_(with_points(model.transfer->encoding, vertices_.points),
               model.transfer->weight_format, exit.end_location()),
      kept_(exit, places_of(vertices_), model.indices.size(), positions, indices) {
  const cpca::Encoding& encoding = model.transfer->encoding;
  std::vector<Vec3> sorted_positions;
  std::vector<std::uint32_t> constants;
  for (const std::uint32_t vertex : vertices_.points) {
    sorted_positions.push_back(model.positions[vertex]);
    constants.push_back(first_constants_[encoding.cluster_of_point[vertex]]);
  }
  positions_ = gl::Buffer(std::span<const Vec3>(sorted_positions));
  constants_of_vertices_ = gl::Buffer(std::span<const std::uint32_t>(constants));
  array_.set_floats(0, positions_, 3, sizeof(Vec3), 0);
  array_.set_uints(kConstantsLocation, constants_of_vertices_);
  weights_.attach(array_);
  const gl::Defines defines =
      gl::joined({weights_.defines(),
                  exit.capture_defines(),
                  {fmt::format("CONSTANT_COUNT {}", encoding.component_count + 1)}});
  programs_ = LightPrograms([=](bool varies) {
    return ExitBuffer::capturing(varies ? "transfer_single.vert" : "transfer_sum.vert",
                                 gl::joined({light_field_defines(varies), defines}));
  });
}

void ClusterSums::fill(const LightGrid& grid, const std::vector<Vec4>& constants,
                       const gl::Table& table) {
  const bool varies = grid.size > 1;
  const gl::Program& program = programs_.of(varies);
  const ExitLayout& layout = exit_.layout();
  const std::size_t constant_count = first_constants_.back();
  program.use();
  weights_.bind(program);
  array_.bind();
  if (varies) {
    grid.bind(program);
    program.set("u_constants", 0);
    program.set("u_sample_size", layout.pass_count * static_cast<int>(constant_count));
    table.bind(0);
  }
  kept_.fill([&](int color) {
    // Where the colour's constants begin, pass_vector_count() apart.
    const std::size_t first = static_cast<std::size_t>(color) * layout.color_vector_count() *
                              (layout.pass_count == 1 ? 1 : constant_count);
    if (!varies) return draw_clusters(program, &constants[first]);
    program.set("u_first_vector", static_cast<int>(first));
    gl::draw_points(0, vertices_.points.size());
  });
}

void ClusterSums::draw_clusters(const gl::Program& program, const Vec4* constants) const {
  const int location = program.location("u_constants");
  const std::size_t vectors = exit_.layout().color_vector_count();
  const std::size_t stride = exit_.layout().pass_vector_count();
  std::vector<Vec4> own;  // constants of a cluster
  for (std::size_t k = 0; k + 1 < first_constants_.size(); ++k) {
    const std::size_t vertex_count = vertices_.of(k).size();
    if (vertex_count == 0) continue;
    own.clear();
    for (std::size_t i = first_constants_[k]; i < first_constants_[k + 1]; ++i)
      own.insert(own.end(), constants + i * stride, constants + i * stride + vectors);
    glUniform4fv(location, static_cast<GLsizei>(own.size()), &own.front().x);
    gl::draw_points(vertices_.offsets[k], vertex_count);
  }
}

}  // namespace prt::runtime
