// Exit values of compressed transfer summed to be kept: vertices cluster by cluster, the constants
// of each cluster in uniform registers at places that the compiler knows, which is several times as
// fast as from a table. Triangles, which lie between clusters, cannot be drawn so without overdraw
// and blending; points can.
#pragma once

#include <cstdint>
#include <vector>

#include "cpca/clusters.h"
#include "runtime/exit_buffer.h"
#include "runtime/light_field.h"
#include "runtime/light_programs.h"
#include "runtime/model.h"
#include "runtime/weight_inputs.h"

namespace prt::runtime {

class ClusterSums {
 public:
  /// The model has compressed transfer; `exit`, made for it, must outlive this.
  ClusterSums(const Model& model, const ExitStage& exit, const gl::Buffer& positions,
              const gl::Buffer& indices);

  /// The light has changed.
  void outdate() { kept_.outdate(); }
  bool is_current() const { return kept_.is_current(); }
  /// As ExitBuffer's.
  [[nodiscard]] bool make_room() { return kept_.make_room(); }
  /// Sums, after make_room(). `constants`: of ClusterConstants for each sample of the light; the
  /// table has the same. Where light varies, all vertices are drawn at once, with constants from
  /// the table.
  void fill(const LightGrid& grid, const std::vector<Vec4>& constants, const gl::Table& table);
  /// After fill().
  void draw(const Viewpoint& viewpoint) const { kept_.draw(viewpoint); }

 private:
  void draw_clusters(const gl::Program& program, const Vec4* constants) const;

  const ExitStage& exit_;
  cpca::PointsByCluster vertices_;  // captured in this order
  std::vector<std::uint32_t> first_constants_;
  WeightInputs weights_;
  gl::Buffer positions_, constants_of_vertices_;
  gl::VertexArray array_;
  LightPrograms programs_;
  ExitBuffer kept_;
};

}  // namespace prt::runtime
