// The tree of 16-wide nodes that our kernels walk: ShadowTree with beams, the engine for large
// scenes ray by ray. Large trees are built a part at a time and lie in mapped files
// (core/mapped_array.h), so that neither building nor walking takes memory that grows with the
// scene.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "core/mapped_array.h"
#include "ray/engine.h"
#include "ray/shadow_query.h"

namespace prt::ray {

/// Triangles that are asked for one by one; corners(i), from any thread, as check_triangles wants
/// them.
struct TriangleSource {
  std::size_t count = 0;
  std::function<std::array<Vec3, 3>(std::size_t triangle)> corners;

  static TriangleSource of(const Triangles& triangles);  ///< which must outlive it
};

struct WideTreeOptions {
  std::filesystem::path folder{};          ///< of the files that hold the tree; empty: in memory
  std::size_t part_triangles = 1'500'000;  ///< that are built at a time; some 90 bytes each
};

class WideTree {
 public:
  /// Some 49 bytes a triangle; on disk, while it is built, 8 more. Throws Error (failed).
  explicit WideTree(const TriangleSource& triangles, const WideTreeOptions& options = {});

  WideTreeView view() const { return {nodes_.data(), root_, rows_.data(), numbers_.data()}; }
  /// Coordinates in the tree: a power of two times the given ones, which makes them at most 1: no
  /// overflow, no loss.
  float scale() const { return scale_; }

 private:
  friend class WideTreeBuilder;
  MappedArray<ShadowNode> nodes_;
  MappedArray<float> rows_;
  MappedArray<std::uint32_t> numbers_;
  float scale_ = 1.0f;
  std::uint32_t root_ = 0;
};

}  // namespace prt::ray
