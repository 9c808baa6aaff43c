#include "transfer/buried.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

#include "core/parallel.h"

namespace prt::transfer {

namespace {

constexpr std::size_t kLeakShare = 1000;   // rays that may slip out between faces: one in so many
constexpr std::size_t kSuspectBlock = 16;  // vertices of a parallel block
constexpr float kContact = 0x1p-16f;       // four steps of ray::offset_origin
constexpr float kInsideShare = 0.9f;       // a corner of a dark room touches walls with 3/4

/// Vertices that are one point of the surface.
struct Node {
  std::vector<std::uint32_t> members;
  std::vector<std::uint32_t> neighbours;  ///< nodes, in order
  bool resolved = true;

  void add_neighbour(std::uint32_t node) {
    const auto place = std::lower_bound(neighbours.begin(), neighbours.end(), node);
    if (place == neighbours.end() || *place != node) neighbours.insert(place, node);
  }
};

using Key = std::array<float, 6>;

Key key_of(const SceneIndex& index, std::uint32_t vertex) {
  const Vec3 p = index.position(vertex);
  const Vec3 n = index.normal(vertex);
  return {p.x, p.y, p.z, n.x, n.y, n.z};
}

/// The graph of the triangles that touch a buried vertex.
std::vector<Node> buried_graph(const SceneIndex& index, std::span<const std::uint8_t> buried) {
  std::vector<Node> nodes;
  std::map<Key, std::uint32_t> node_of_key;
  for_each_trimmed(index.triangle_count(), [&](std::size_t t) {
    const std::array<std::uint32_t, 3> corners = index.triangle(t);
    if (std::none_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return buried[v]; })) {
      return;
    }
    std::array<std::uint32_t, 3> node;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto next = static_cast<std::uint32_t>(nodes.size());
      node[k] = node_of_key.try_emplace(key_of(index, corners[k]), next).first->second;
      if (node[k] == nodes.size()) nodes.emplace_back();
      Node& at = nodes[node[k]];
      if (std::find(at.members.begin(), at.members.end(), corners[k]) == at.members.end()) {
        at.members.push_back(corners[k]);
        at.resolved = at.resolved && !buried[corners[k]];
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      nodes[node[k]].add_neighbour(node[(k + 1) % 3]);
      nodes[node[k]].add_neighbour(node[(k + 2) % 3]);
    }
  });
  return nodes;
}

/// Whether most of what a vertex sees are backs of faces or at its own place.
bool is_inside(Hemisphere& hemisphere, std::size_t vertex, float magnitude) {
  hemisphere.trace(vertex);
  const std::span<const ray::Hit> hits = hemisphere.hits();
  float inside = 0.0f, total = 0.0f;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].triangle == ray::kNoHit) continue;
    const float cosine = hemisphere.blocked()[i].weight;
    total += cosine;
    if (hits[i].back_face || hits[i].t <= kContact * magnitude) inside += cosine;
  }
  return inside > kInsideShare * total;
}

}  // namespace

bool sees_nothing(const Hemisphere& hemisphere) {
  const std::size_t blocked_count = hemisphere.blocked().size();
  return blocked_count > 0 && hemisphere.visible_count() * kLeakShare <= blocked_count;
}

std::uint64_t confirm_buried(const SceneIndex& index, const Directions& directions,
                             std::span<std::uint8_t> buried) {
  std::vector<std::uint32_t> suspects;
  for_each_trimmed(index.vertex_count(), [&](std::size_t i) {
    const std::uint32_t v = index.vertex_order()[i];
    if (buried[v]) suspects.push_back(v);
  });
  if (suspects.empty()) return 0;
  index.engine();  // is built by all threads, not by the first that asks for it
  std::vector<std::uint64_t> rays(block_count(suspects.size(), kSuspectBlock));
  parallel_for(suspects.size(), kSuspectBlock, [&](std::size_t begin, std::size_t end) {
    Hemisphere hemisphere(index, directions);
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t v = suspects[i];
      buried[v] = is_inside(hemisphere, v, index.magnitude(v));
    }
    rays[begin / kSuspectBlock] = hemisphere.rays_cast();
  });
  return std::accumulate(rays.begin(), rays.end(), std::uint64_t{0});
}

BuriedRepair::BuriedRepair(const SceneIndex& index, std::span<const std::uint8_t> buried) {
  std::vector<Node> nodes = buried_graph(index, buried);
  std::vector<std::size_t> ring;
  do {
    ring.clear();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i].resolved) continue;
      const std::size_t begin = sources_.size();
      for (const std::uint32_t neighbour : nodes[i].neighbours) {
        if (nodes[neighbour].resolved) sources_.push_back(nodes[neighbour].members.front());
      }
      if (sources_.size() == begin) continue;
      ring.push_back(i);
      for (std::uint32_t v : nodes[i].members) steps_.push_back({v, begin, sources_.size()});
    }
    for (std::size_t i : ring) nodes[i].resolved = true;
  } while (!ring.empty());
}

MappedArray<std::uint32_t> BuriedRepair::stand_ins(const SceneIndex& index) const {
  MappedArray<std::uint32_t> stand_ins(index.vertex_count(), index.scratch_folder());
  for_each_trimmed(stand_ins.size(),
                   [&](std::size_t v) { stand_ins[v] = static_cast<std::uint32_t>(v); });
  for_each_trimmed(steps_.size(), [&](std::size_t i) {
    stand_ins[steps_[i].vertex] = stand_ins[sources_[steps_[i].source_begin]];
  });
  return stand_ins;
}

void BuriedRepair::apply(float* rows, std::size_t stride) const {
  for (const Step& step : steps_) {
    float* row = rows + step.vertex * stride;
    std::fill_n(row, stride, 0.0f);
    const float weight = 1.0f / static_cast<float>(step.source_end - step.source_begin);
    for (std::size_t s = step.source_begin; s < step.source_end; ++s) {
      const float* source = rows + sources_[s] * stride;
      for (std::size_t j = 0; j < stride; ++j) row[j] += weight * source[j];
    }
    trim_mapped_arrays();
  }
}

}  // namespace prt::transfer
