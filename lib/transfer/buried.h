// Vertices whose hemisphere is buried in other geometry (a floor vertex under a resting block, one
// inside a closed body): they see nothing, and dark they would stain the triangles around them.
// They take the mean of the nearest vertices along mesh edges that are not buried.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mapped_array.h"
#include "transfer/hemisphere.h"
#include "transfer/scene_index.h"

namespace prt::transfer {

/// Whether the vertex last traced may be buried: of its rays at most one in a thousand leaves the
/// scene.
bool sees_nothing(const Hemisphere& hemisphere);

/// Clears the marks, buried[v] != 0, of vertices that see nothing but are not buried: of a buried
/// one nine in ten rays (by cosine) hit backs of faces, which only a point inside of something
/// sees, or end within rounding of their origin. A dark open cavity shows fronts at a distance.
/// Returns the number of rays cast. Not for several threads at a time.
std::uint64_t confirm_buried(const SceneIndex& index, const Directions& directions,
                             std::span<std::uint8_t> buried);

/// How to fill in rows of buried vertices, made once and applied to any field over the vertices.
/// Vertices with equal position and normal (seams of texture coordinates) count as one.
class BuriedRepair {
 public:
  /// buried[v] != 0 marks vertices.
  BuriedRepair(const SceneIndex& index, std::span<const std::uint8_t> buried);

  /// Fills the marked rows of a field of `stride` floats a vertex; rows of vertices that nothing
  /// unburied is connected to stay as they are.
  void apply(float* rows, std::size_t stride) const;
  /// One vertex for each of the index: itself, or for a marked one the first of those that its
  /// row is the mean of, or what stands for that.
  MappedArray<std::uint32_t> stand_ins(const SceneIndex& index) const;
  std::size_t repaired_count() const { return steps_.size(); }

 private:
  struct Step {
    std::uint32_t vertex;
    std::size_t source_begin, source_end;  ///< in sources_; their mean is the vertex's row
  };
  std::vector<Step> steps_;  ///< in rings outward from unburied vertices, so sources come first
  std::vector<std::uint32_t> sources_;
};

}  // namespace prt::transfer
