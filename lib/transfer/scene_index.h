// A scene's vertices and triangles numbered through, and what traces rays among them. Of a large
// scene all that grows with it lies in mapped files (core/mapped_array.h).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "core/mapped_array.h"
#include "core/spatial_order.h"
#include "mesh/scene.h"
#include "ray/engine.h"
#include "ray/shadow_tree.h"
#include "ray/wide_tree.h"

namespace prt::transfer {

/// Where what grows with a scene lies.
struct ScratchOptions {
  std::filesystem::path folder{};            ///< empty: all in memory
  std::size_t in_memory_vertices = 750'000;  ///< of more, in nameless files in the folder
};

class SceneIndex {
 public:
  /// Throws Error (bad_input) on numbers that are not finite, Error (failed) on more than 2^32 - 2
  /// vertices or triangles and when the scratch folder has no room. The scene must outlive this.
  explicit SceneIndex(const mesh::Scene& scene, const ScratchOptions& scratch = {});

  struct Place {
    std::size_t primitive;
    std::size_t local;  ///< number of the vertex or triangle in that primitive
  };
  Place vertex_place(std::size_t vertex) const { return place(vertex_offsets_, vertex); }
  Place triangle_place(std::size_t triangle) const { return place(triangle_offsets_, triangle); }

  const mesh::Scene& scene() const { return scene_; }
  /// For hits, and for shadow rays where there is no shadow tree; built when first asked for, which
  /// threads should not be the first to do. Embree's, or that of large scenes (ray/wide_engine.h).
  const ray::Engine& engine() const;
  /// For shadow rays; built in the same way. Null where the engine is faster.
  const ray::ShadowTree* shadow_tree() const;
  /// Builds what answers so many rays a vertex fastest: the shadow tree, or, where its beams would
  /// be wide for so many triangles, the engine.
  void build_for_shadow_rays(int ray_count);
  /// Whether what grows with the scene is to lie in files, and in which folder; empty: in memory.
  bool is_large() const { return !scratch_folder_.empty(); }
  const std::filesystem::path& scratch_folder() const { return scratch_folder_; }
  std::size_t vertex_count() const { return vertex_offsets_.back(); }
  std::size_t triangle_count() const { return triangle_offsets_.back(); }
  const Vec3& normal(std::size_t vertex) const;
  /// Relative to the scene's centre, in units of about its size, as all that is traced.
  Vec3 position(std::size_t vertex) const;
  /// Where the vertex's rays start: off the surface by ray::offset_origin's step and, at the edge
  /// of a surface, about as much away from the edge: the rays of a floor's edge start in front of
  /// the wall that stands there, and no light comes in between. As position(): scenes far from the
  /// origin keep their precision, and any unit of length is right. The same for vertices of equal
  /// position and normal.
  const Vec3& ray_origin(std::size_t vertex) const { return ray_origins_[vertex]; }
  /// Largest coordinate around the vertex, as of position(); the unit of rounding errors.
  float magnitude(std::size_t vertex) const { return magnitudes_[vertex]; }
  /// Vertices of a triangle, numbered through.
  std::array<std::uint32_t, 3> triangle(std::size_t triangle) const;
  /// Vertices in an order that keeps neighbours together.
  std::span<const std::uint32_t> vertex_order() const { return vertex_order_; }

 private:
  /// Sums over the triangles around a vertex.
  struct Surroundings {
    Vec4 inward{0.0f};  ///< of unit vectors to their middles, and how many
    float magnitude = 0.0f;
  };
  void find_ray_origins(const SpatialGrid& grid);
  void add_triangles(MappedArray<Surroundings>& around) const;
  void share_between_equals(const SpatialGrid& grid, MappedArray<Surroundings>& around) const;
  Vec3 traced(const Vec3& p) const { return (p - centre_) * scale_; }
  static Place place(const std::vector<std::size_t>& offsets, std::size_t number);
  ray::TriangleSource triangle_source() const;
  std::unique_ptr<ray::Engine> make_embree_engine() const;
  const std::shared_ptr<const ray::WideTree>& wide_tree() const;

  const mesh::Scene& scene_;
  std::vector<std::size_t> vertex_offsets_, triangle_offsets_;
  Vec3 centre_{0.0f};
  float scale_ = 1.0f;
  std::filesystem::path scratch_folder_;
  MappedArray<float> magnitudes_;
  MappedArray<Vec3> ray_origins_;
  MappedArray<std::uint32_t> vertex_order_;
  bool prefers_engine_ = false;  // for shadow rays
  mutable std::once_flag wide_tree_once_, engine_once_, shadow_tree_once_;
  mutable std::shared_ptr<const ray::WideTree> wide_tree_;
  mutable std::unique_ptr<ray::Engine> engine_;
  mutable std::unique_ptr<ray::ShadowTree> shadow_tree_;
};

}  // namespace prt::transfer
