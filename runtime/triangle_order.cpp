#include "runtime/triangle_order.h"

#include <utility>

namespace prt::runtime {

namespace {

// Vertices that the order expects to be kept: what GPUs have, and few enough for every one of them.
constexpr std::uint32_t kCacheSize = 16;

/// Draws all triangles around one vertex after the other, the next one among those just drawn.
class FanOrder {
 public:
  FanOrder(std::span<const std::uint32_t> indices, std::size_t vertex_count)
      : indices_(indices),
        first_(vertex_count + 1, 0),
        around_(indices.size()),
        left_(vertex_count, 0),
        entered_(vertex_count, 0),
        is_drawn_(indices.size() / 3, false) {
    for (const std::uint32_t v : indices) ++left_[v];
    for (std::size_t v = 0; v < vertex_count; ++v) first_[v + 1] = first_[v] + left_[v];
    std::vector<std::size_t> end(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < indices.size(); ++i) around_[end[indices[i]]++] = i / 3;
    order_.reserve(indices.size());
  }

  std::vector<std::uint32_t> run() {
    for (std::uint32_t start = 0; start < left_.size(); ++start) {
      std::uint32_t v = start;
      while (left_[v] > 0) {
        draw_around(v);
        v = next(start);
      }
    }
    return std::move(order_);
  }

 private:
  void draw_around(std::uint32_t v) {
    fan_begin_ = order_.size();
    for (std::size_t i = first_[v]; i < first_[v + 1]; ++i) {
      const std::size_t triangle = around_[i];
      if (is_drawn_[triangle]) continue;
      is_drawn_[triangle] = true;
      for (const std::uint32_t corner : indices_.subspan(3 * triangle, 3)) {
        order_.push_back(corner);
        recent_.push_back(corner);
        --left_[corner];
        if (clock_ - entered_[corner] > kCacheSize) entered_[corner] = clock_++;
      }
    }
  }

  /// Of the last fan's corners the one longest in the cache that will still be there after its own
  /// triangles, which bring in up to two vertices each; else one with triangles left, the most
  /// recent first; `start` when there is none.
  std::uint32_t next(std::uint32_t start) {
    std::uint32_t best = start, best_age = 0;
    bool found = false;
    for (std::size_t i = fan_begin_; i < order_.size(); ++i) {
      const std::uint32_t v = order_[i], age = clock_ - entered_[v];
      if (left_[v] == 0) continue;
      const std::uint32_t kept_age = age + 2 * left_[v] <= kCacheSize ? age : 0;
      if (found && kept_age <= best_age) continue;
      best = v, best_age = kept_age, found = true;
    }
    while (!found && !recent_.empty()) {
      best = recent_.back();
      recent_.pop_back();
      found = left_[best] > 0;
    }
    return found ? best : start;
  }

  std::span<const std::uint32_t> indices_;
  std::vector<std::size_t> first_, around_;  // of each vertex, its triangles
  std::vector<std::uint32_t> left_;          // triangles of a vertex that are not drawn yet
  std::vector<std::uint32_t> entered_;       // when a vertex entered the cache
  std::vector<bool> is_drawn_;
  std::uint32_t clock_ = kCacheSize + 1;  // vertices that have entered
  std::vector<std::uint32_t> order_, recent_;
  std::size_t fan_begin_ = 0;  // of the last fan, in the order
};

}  // namespace

std::vector<std::uint32_t> ordered_for_vertex_reuse(std::span<const std::uint32_t> indices,
                                                    std::size_t vertex_count) {
  return FanOrder(indices, vertex_count).run();
}

}  // namespace prt::runtime
