#include "ray/shadow_tree.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace prt::ray {

namespace {

constexpr std::size_t kLeafSize = 16;
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

/// Gathers Embree's binary tree into wide nodes, from the leaves up: two branches share a node as
/// long as their slots fit into one, so that the many nodes at the bottom are well filled.
class ShadowTreeBuilder {
 public:
  ShadowTreeBuilder(const Triangles& triangles, ShadowTree& tree)
      : triangles_(triangles), tree_(tree) {
    float largest = 0.0f;
    for (const Vec3& p : triangles.positions) {
      largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    if (largest > 0.0f) tree.scale_ = std::ldexp(1.0f, -std::max(std::ilogb(largest) + 1, -126));
    Slots top;
    if (!triangles.indices.empty()) build(top);
    tree_.root_ = close(top).child;
    tree_.triangles_.resize(9 * triangle_count_ + kNodeWidth);  // for loads past the end
    tree_.triangles_.shrink_to_fit();
    tree_.nodes_.shrink_to_fit();
  }

 private:
  Vec3 corner(std::size_t triangle, std::size_t k) const {
    return triangles_.positions[triangles_.indices[3 * triangle + k]] * tree_.scale_;
  }

  void build(Slots& top) {
    const std::unique_ptr<RTCDeviceTy, void (*)(RTCDevice)> device(rtcNewDevice(nullptr),
                                                                   rtcReleaseDevice);
    if (!device) throw_failed("Embree cannot start");
    const std::unique_ptr<RTCBVHTy, void (*)(RTCBVH)> hierarchy(rtcNewBVH(device.get()),
                                                                rtcReleaseBVH);
    std::vector<RTCBuildPrimitive> primitives = boxes();
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.minLeafSize = arguments.maxLeafSize = kLeafSize;
    arguments.bvh = hierarchy.get();
    arguments.primitives = primitives.data();
    arguments.primitiveCount = arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = create_leaf;
    const auto* root = static_cast<const Branch*>(rtcBuildBVH(&arguments));
    if (!root) {
      throw_failed("Embree cannot build the shadow tree",
                   {.found = fmt::format("error {}", int{rtcGetDeviceError(device.get())})});
    }
    std::vector<RTCBuildPrimitive>().swap(primitives);
    tree_.triangles_.reserve(3 * triangles_.indices.size() + kNodeWidth);
    gather(*root, 1, top);
  }

  std::vector<RTCBuildPrimitive> boxes() const {
    std::vector<RTCBuildPrimitive> result(triangles_.indices.size() / 3);
    for (std::size_t i = 0; i < result.size(); ++i) {
      Box box;
      for (std::size_t k = 0; k < 3; ++k) box.extend(corner(i, k));
      result[i] = {box.lower.x, box.lower.y, box.lower.z, 0,
                   box.upper.x, box.upper.y, box.upper.z, static_cast<unsigned>(i)};
    }
    return result;
  }

  void gather(const Branch& branch, int depth, Slots& out) {
    if (depth > kMaxTreeDepth) throw_failed("the shadow tree is too deep");
    if (!branch.children[0]) {
      out.slots[0] = leaf(branch);
      out.count = 1;
      return;
    }
    Slots other;
    gather(*branch.children[0], depth + 1, out);
    gather(*branch.children[1], depth + 1, other);
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
    tree_.triangles_.resize(9 * (triangle_count_ + branch.count));
    float* rows = &tree_.triangles_[9 * triangle_count_];
    for (std::size_t i = 0; i < branch.count; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 p = corner(branch.triangles[i], k);
        slot.box.extend(p);
        for (std::size_t c = 0; c < 3; ++c) {
          rows[(3 * k + c) * branch.count + i] = p[static_cast<int>(c)];
        }
      }
    }
    triangle_count_ += branch.count;
    return slot;
  }

  Slot close(const Slots& slots) {
    Slot result{{}, static_cast<std::uint32_t>(tree_.nodes_.size()), 0};
    ShadowNode& node = tree_.nodes_.emplace_back();
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
    return result;
  }

  const Triangles& triangles_;
  ShadowTree& tree_;
  std::size_t triangle_count_ = 0;
};

ShadowTree::ShadowTree(const Triangles& triangles, SimdLevel level) : level_(level) {
  check_triangles(triangles);
  ShadowTreeBuilder(triangles, *this);
}

void ShadowTree::trace(const Vec3& origin, const Vec3& normal, std::span<const Beam> beams,
                       std::span<BeamLanes> lanes) const {
  assert(lanes.size() == beams.size());
  const Vec3 o = origin * scale_;
  // Roundings of the nodes' tests are below 14 units of 2^-24 of the largest coordinate.
  const float margin = 0x1p-20f * std::max({1.0f, std::abs(o.x), std::abs(o.y), std::abs(o.z)});
  const ShadowQuery query{{o.x, o.y, o.z}, {normal.x, normal.y, normal.z}, margin};
  kernel_for(level_, trace_shadows_avx512, trace_shadows_avx2, trace_shadows_baseline)(
      {nodes_.data(), root_, triangles_.data()}, query, beams.data(), beams.size(), lanes.data());
}

}  // namespace prt::ray
