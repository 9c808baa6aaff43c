// A scene's vertices and triangles numbered through, and what traces rays among them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "mesh/scene.h"
#include "ray/engine.h"
#include "ray/shadow_tree.h"

namespace prt::transfer {

class SceneIndex {
 public:
  /// Throws Error (bad_input) on numbers that are not finite or too large to be traced, Error
  /// (failed) on more than 2^32 - 2 vertices or triangles. The scene must outlive this.
  explicit SceneIndex(const mesh::Scene& scene);

  struct Place {
    std::size_t primitive;
    std::size_t local;  ///< number of the vertex or triangle in that primitive
  };
  Place vertex_place(std::size_t vertex) const { return place(vertex_offsets_, vertex); }
  Place triangle_place(std::size_t triangle) const { return place(triangle_offsets_, triangle); }

  const mesh::Scene& scene() const { return scene_; }
  /// For hits; built when first asked for, which threads should not be the first to do.
  const ray::Engine& engine() const;
  /// For shadow rays; built in the same way. Null after drop_shadow_tree: the engine then serves.
  const ray::ShadowTree* shadow_tree() const;
  /// Builds what answers so many rays a vertex fastest: the shadow tree, or, where its beams would
  /// be wide for so many triangles, the engine.
  void build_for_shadow_rays(int ray_count);
  /// Gives the shadow tree's memory back, some 100 bytes a vertex, for good.
  void drop_shadow_tree();
  std::size_t vertex_count() const { return vertex_offsets_.back(); }
  std::size_t triangle_count() const { return triangle_offsets_.back(); }
  const Vec3& normal(std::size_t vertex) const;
  /// Relative to the scene's centre.
  Vec3 position(std::size_t vertex) const;
  /// Where the vertex's rays start: off the surface by ray::offset_origin's step and, at the edge
  /// of a surface, about as much away from the edge: the rays of a floor's edge start in front of
  /// the wall that stands there, and no light comes in between. Relative to the scene's centre, as
  /// all that is traced: small scenes far from the origin keep their precision. The same for
  /// vertices of equal position and normal.
  const Vec3& ray_origin(std::size_t vertex) const { return ray_origins_[vertex]; }
  /// Largest coordinate around the vertex, relative to the centre; the unit of rounding errors.
  float magnitude(std::size_t vertex) const { return magnitudes_[vertex]; }
  /// Vertices of a triangle, numbered through.
  std::array<std::uint32_t, 3> triangle(std::size_t triangle) const;
  /// Vertices in an order that keeps neighbours together.
  const std::vector<std::uint32_t>& vertex_order() const { return vertex_order_; }

 private:
  void find_ray_origins(std::span<const Vec3> positions, std::span<const std::uint32_t> indices);
  void share_between_equals(std::span<const Vec3> positions, std::vector<Vec4>& inward);
  static Place place(const std::vector<std::size_t>& offsets, std::size_t number);

  struct TriangleList {
    std::vector<Vec3> positions;  ///< relative to the centre
    std::vector<std::uint32_t> indices;

    ray::Triangles view() const { return {positions, indices}; }
  };
  TriangleList triangle_list() const;

  const mesh::Scene& scene_;
  std::vector<std::size_t> vertex_offsets_, triangle_offsets_;
  Vec3 centre_{0.0f};
  std::vector<float> magnitudes_;
  std::vector<Vec3> ray_origins_;
  std::vector<std::uint32_t> vertex_order_;
  mutable std::once_flag engine_once_, shadow_tree_once_;
  mutable std::unique_ptr<ray::Engine> engine_;
  mutable std::unique_ptr<ray::ShadowTree> shadow_tree_;
};

}  // namespace prt::transfer
