#include "ray/wide_tree.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "core/spatial_order.h"

namespace prt::ray {

namespace {

constexpr std::size_t kLeafSize = 16;
constexpr int kMaxJoins = 12;  // levels above the parts: 2^32 triangles are fewer than 2^12 parts
constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Box {
  Vec3 lower{kInfinity}, upper{-kInfinity};

  void extend(const Vec3& p) {
    for (int c = 0; c < 3; ++c) {
      lower[c] = std::min(lower[c], p[c]);
      upper[c] = std::max(upper[c], p[c]);
    }
  }
};

/// Embree's builder makes a binary tree of these.
struct Branch {
  const Branch* children[2];  ///< null in a leaf
  std::uint32_t count;        ///< of the leaf's triangles
  std::uint32_t triangles[kLeafSize];
};

void* create_node(RTCThreadLocalAllocator allocator, unsigned, void*) {
  return new (rtcThreadLocalAlloc(allocator, sizeof(Branch), alignof(Branch))) Branch{};
}
void set_children(void* node, void** children, unsigned count, void*) {
  assert(count == 2);
  for (unsigned i = 0; i < count; ++i) {
    static_cast<Branch*>(node)->children[i] = static_cast<const Branch*>(children[i]);
  }
}
void set_bounds(void*, const RTCBounds**, unsigned, void*) {}
void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives,
                  std::size_t count, void*) {
  assert(count <= kLeafSize);
  auto* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(Branch), alignof(Branch))) Branch{};
  leaf->count = static_cast<std::uint32_t>(count);
  for (std::size_t i = 0; i < count; ++i) leaf->triangles[i] = primitives[i].primID;
  return leaf;
}

/// A child of the node to be: a leaf or a finished node.
struct Slot {
  Box box;
  std::uint32_t child = 0, triangle_count = 0;
};
struct Slots {
  Slot slots[kNodeWidth];
  int count = 0;
};

}  // namespace

/// Gathers Embree's binary trees into wide nodes, from the leaves up: two branches share a node as
/// long as their slots fit into one, so that the many nodes at the bottom are well filled. The
/// parts of a large scene follow each other in space and are joined like branches.
class WideTreeBuilder {
 public:
  WideTreeBuilder(const TriangleSource& triangles, const WideTreeOptions& options, WideTree& tree)
      : triangles_(triangles), options_(options), tree_(tree), device_(rtcNewDevice(nullptr)) {
    if (!device_) throw_failed("Embree cannot start");
    tree.nodes_ = MappedArray<ShadowNode>(0, options.folder);
    tree.rows_ = MappedArray<float>(9 * triangles.count + kNodeWidth, options.folder);
    tree.numbers_ = MappedArray<std::uint32_t>(triangles.count, options.folder);
    tree.scale_ = find_scale();
    const std::size_t parts = block_count(triangles.count, options.part_triangles);
    if (parts > 1) {
      const auto middle = [&](std::size_t i) {
        const std::array<Vec3, 3> p = triangles.corners(i);
        return p[0] / 3.0f + p[1] / 3.0f + p[2] / 3.0f;
      };
      order_ = spatial_order({triangles.count, middle}, triangles.count, middle, options.folder);
    }
    Slots top;
    if (parts > 0) build(0, parts, top);
    tree.root_ = close(top).child;
  }

 private:
  struct DeviceDeleter {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  };

  float find_scale() const {
    float largest = 0.0f;
    for (std::size_t i = 0; i < triangles_.count; ++i) {
      for (const Vec3& p : triangles_.corners(i)) {
        largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
      }
    }
    return 0.5f * unit_scale(largest);
  }

  std::array<Vec3, 3> corners(std::size_t triangle) const {
    std::array<Vec3, 3> corners = triangles_.corners(triangle);
    for (Vec3& p : corners) p *= tree_.scale_;
    return corners;
  }

  /// The parts [first, end), which are not none.
  void build(std::size_t first, std::size_t end, Slots& out) {
    if (end - first == 1) return build_part(first, out);
    const std::size_t middle = first + (end - first) / 2;
    Slots other;
    build(first, middle, out);
    build(middle, end, other);
    join(out, other);
  }

  void build_part(std::size_t part, Slots& out) {
    const std::unique_ptr<RTCBVHTy, void (*)(RTCBVH)> hierarchy(rtcNewBVH(device_.get()),
                                                                rtcReleaseBVH);
    find_boxes(part);
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.minLeafSize = arguments.maxLeafSize = kLeafSize;
    arguments.bvh = hierarchy.get();
    arguments.primitives = boxes_.data();
    arguments.primitiveCount = arguments.primitiveArrayCapacity = boxes_.size();
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = create_leaf;
    const auto* root = static_cast<const Branch*>(rtcBuildBVH(&arguments));
    if (!root) {
      throw_failed("Embree cannot build the tree of triangles",
                   {.found = fmt::format("error {}", int{rtcGetDeviceError(device_.get())})});
    }
    gather(*root, 1, out);
  }

  /// Of the part's triangles, for Embree.
  void find_boxes(std::size_t part) {
    const std::size_t first = part * options_.part_triangles;
    boxes_.resize(std::min(options_.part_triangles, triangles_.count - first));
    parallel_for(boxes_.size(), kBoxBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t triangle = order_.empty() ? first + i : order_[first + i];
        Box box;
        for (const Vec3& p : corners(triangle)) box.extend(p);
        boxes_[i] = {box.lower.x, box.lower.y, box.lower.z, 0,
                     box.upper.x, box.upper.y, box.upper.z, static_cast<unsigned>(triangle)};
      }
      trim_mapped_arrays();
    });
  }

  void gather(const Branch& branch, int depth, Slots& out) {
    if (depth > kMaxTreeDepth - kMaxJoins) throw_failed("the tree of triangles is too deep");
    if (!branch.children[0]) {
      out.slots[0] = leaf(branch);
      out.count = 1;
      return;
    }
    Slots other;
    gather(*branch.children[0], depth + 1, out);
    gather(*branch.children[1], depth + 1, other);
    join(out, other);
  }

  /// Adds the slots of `other`.
  void join(Slots& out, Slots& other) {
    for (Slots* larger = out.count >= other.count ? &out : &other;
         out.count + other.count > kNodeWidth; larger = larger == &out ? &other : &out) {
      larger->slots[0] = close(*larger);
      larger->count = 1;
    }
    std::copy_n(other.slots, other.count, out.slots + out.count);
    out.count += other.count;
  }

  Slot leaf(const Branch& branch) {
    Slot slot{{}, static_cast<std::uint32_t>(triangle_count_), branch.count};
    float* rows = &tree_.rows_[9 * triangle_count_];
    for (std::size_t i = 0; i < branch.count; ++i) {
      const std::array<Vec3, 3> triangle = corners(branch.triangles[i]);
      for (std::size_t k = 0; k < 3; ++k) {
        slot.box.extend(triangle[k]);
        for (std::size_t c = 0; c < 3; ++c) {
          rows[(3 * k + c) * branch.count + i] = triangle[k][static_cast<int>(c)];
        }
      }
      tree_.numbers_[triangle_count_ + i] = branch.triangles[i];
    }
    triangle_count_ += branch.count;
    if (++leaf_count_ % kLeavesPerTrim == 0) trim_mapped_arrays();
    return slot;
  }

  Slot close(const Slots& slots) {
    Slot result{{}, static_cast<std::uint32_t>(tree_.nodes_.size()), 0};
    ShadowNode node{};
    for (std::size_t i = 0; i < kNodeWidth; ++i) {
      const Slot slot = i < static_cast<std::size_t>(slots.count) ? slots.slots[i] : Slot{};
      for (int c = 0; c < 3; ++c) {
        node.bounds[c][i] = slot.box.lower[c];
        node.bounds[3 + c][i] = slot.box.upper[c];
      }
      node.child[i] = slot.child;
      node.triangle_count[i] = static_cast<std::uint8_t>(slot.triangle_count);
      if (i >= static_cast<std::size_t>(slots.count)) continue;
      result.box.extend(slot.box.lower);
      result.box.extend(slot.box.upper);
    }
    tree_.nodes_.push_back(node);
    return result;
  }

  static constexpr std::size_t kBoxBlock = 4096, kLeavesPerTrim = 256;

  const TriangleSource& triangles_;
  const WideTreeOptions& options_;
  WideTree& tree_;
  const std::unique_ptr<RTCDeviceTy, DeviceDeleter> device_;
  MappedArray<std::uint32_t> order_;  // of triangles in space; empty: one part
  std::vector<RTCBuildPrimitive> boxes_;
  std::size_t triangle_count_ = 0, leaf_count_ = 0;
};

TriangleSource TriangleSource::of(const Triangles& triangles) {
  return {triangles.indices.size() / 3, [triangles](std::size_t i) {
            const std::uint32_t* index = &triangles.indices[3 * i];
            return std::array{triangles.positions[index[0]], triangles.positions[index[1]],
                              triangles.positions[index[2]]};
          }};
}

WideTree::WideTree(const TriangleSource& triangles, const WideTreeOptions& options) {
  WideTreeBuilder(triangles, options, *this);
}

}  // namespace prt::ray
