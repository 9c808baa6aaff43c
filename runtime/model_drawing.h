// A model in OpenGL: its buffers, and every way to draw it into the bound target, which has depth.
// Colours are linear exit radiance, alpha is coverage. BlackDrawing comes first and leaves depth
// and coverage; the others then draw where depths are equal. Diffuse transfer in one call needs no
// such start.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gl/objects.h"
#include "gl/program.h"
#include "runtime/cluster_constants.h"
#include "runtime/cluster_sums.h"
#include "runtime/exit_buffer.h"
#include "runtime/exit_stage.h"
#include "runtime/light_programs.h"
#include "runtime/light_vectors.h"
#include "runtime/model.h"
#include "runtime/weight_inputs.h"

namespace prt::runtime {

/// Compressed transfer, adaptive or not; both ways give the same pixels.
class CompressedDrawing {
 public:
  /// The model has compressed transfer; `exit`, made for it, must outlive this. `keep_sums` makes
  /// what draw_kept() needs, where ExitBuffer::fits. Throws Error
  /// (failed) when it has more components than this OpenGL has vertex attributes (not needed by
  /// adaptive transfer) or uniforms for.
  CompressedDrawing(const Model& model, const ExitStage& exit, const gl::Buffer& positions,
                    const gl::Buffer& indices, bool keep_sums);

  void set_light(const LightField& field);

  /// All clusters in one draw call; constants are fetched for each vertex.
  void draw_single(const Viewpoint& viewpoint) const;
  /// The same from exit values that are kept while the light stays (runtime/exit_buffer.h). False,
  /// and nothing drawn, without keep_sums or room for them.
  [[nodiscard]] bool draw_kept(const Viewpoint& viewpoint);
  /// The sums that draw_kept() draws, if the light has changed since; some framebuffer must be
  /// bound. False without keep_sums or room for them.
  bool sum();
  /// The loop of [Sloan03] §6.2: supercluster by supercluster, constants in uniform registers,
  /// added up by blending. Where two triangles coincide exactly, both are added.
  void draw_clusters(const Viewpoint& viewpoint) const;

 private:
  gl::VertexArray make_array(const gl::Buffer& positions, const gl::Buffer& indices) const;
  void make_chunks(const Model& model, const gl::Buffer& positions);
  void make_programs();
  void bind(const gl::Program& program, const Viewpoint& viewpoint) const;
  void draw_chunks(const gl::Program& program, const Vec4* constants) const;

  const ExitStage& exit_;
  std::size_t index_count_, constant_count_;  // constants of a pass
  ClusterConstants products_;
  gl::Buffer constants_of_vertices_, chunk_indices_;
  WeightInputs weights_;
  gl::VertexArray single_array_, chunk_array_;
  std::vector<std::size_t> chunk_offsets_;
  std::vector<std::uint32_t> chunk_constants_;  // the first of each chunk, and how many there are
  LightPrograms single_programs_, cluster_programs_;
  gl::Table constant_table_;
  LightGrid grid_;
  std::vector<Vec4> constants_;  // of each sample of the light, of each pass
  std::optional<ClusterSums> sums_;
};

/// Uncompressed transfer: the product of all coefficients, or of the matrix, with the light in the
/// shader of each vertex.
class UncompressedDrawing {
 public:
  /// The model has an uncompressed signal; `exit` and `keep_sums` as above. Throws Error
  /// (failed) when it does not fit.
  UncompressedDrawing(const Model& model, const ExitStage& exit, const gl::Buffer& positions,
                      const gl::Buffer& indices, bool keep_sums);
  UncompressedDrawing(const UncompressedDrawing&) = delete;  // programs refer to it
  UncompressedDrawing& operator=(const UncompressedDrawing&) = delete;
  /// Whether the signal does.
  static bool fits(const signal::TransferSignal& signal, const ExitLayout& layout);
  void set_light(const LightField& field);
  void draw(const Viewpoint& viewpoint) const;
  /// As CompressedDrawing's.
  [[nodiscard]] bool draw_kept(const Viewpoint& viewpoint);
  bool sum();

 private:
  void bind(const gl::Program& program) const;

  const ExitStage& exit_;
  std::size_t vertex_count_, index_count_;
  int band_count_;
  gl::VertexArray array_;
  gl::Table transfer_;
  LightVectors light_;
  std::optional<ExitBuffer> kept_;
  LightPrograms programs_, sum_programs_;
};

/// Every triangle black: what back faces stay.
class BlackDrawing {
 public:
  BlackDrawing(std::size_t index_count, const gl::Buffer& positions, const gl::Buffer& indices);
  void draw(const Viewpoint& viewpoint) const;

 private:
  std::size_t index_count_;
  gl::VertexArray array_;
  gl::Program program_;
};

/// A colour for each vertex.
class ColorDrawing {
 public:
  ColorDrawing(std::span<const Vec3> colors, std::size_t index_count, const gl::Buffer& positions,
               const gl::Buffer& indices);
  void draw(const Viewpoint& viewpoint) const;

 private:
  std::size_t index_count_;
  gl::Buffer colors_;
  gl::VertexArray array_;
  gl::Program program_;
};

}  // namespace prt::runtime
