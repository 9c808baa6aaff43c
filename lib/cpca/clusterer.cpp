#include "cpca/clusterer.h"

#include <algorithm>
#include <numeric>

#include "core/parallel.h"
#include "cpca/leading.h"
#include "cpca/own_factor.h"
#include "cpca/subspace_kernels.h"
#include "cpca/subspace_update.h"

namespace prt::cpca {

namespace {

constexpr std::size_t kClassifyBlock = 256;
/// Clusters tried between full passes.
constexpr std::size_t kNeighbours = 16;
/// Coordinates that a cluster is first looked at in, where there are at least twice as many.
constexpr std::size_t kLeading = 32;

}  // namespace

Clusterer::Clusterer(const Rows& rows, std::size_t dimension, std::span<const float> means)
    : rows_(rows),
      subspaces_(means.size() / rows.stride, padded(rows.stride), 0),
      labels_(rows.count),
      errors_(rows.count) {
  set_dimension(dimension);
  for (std::size_t k = 0; k < subspaces_.cluster_count(); ++k) {
    std::copy_n(&means[k * rows.stride], rows.stride, subspaces_.mean(k));
  }
  count_clusters();
  neighbours_.resize(subspaces_.cluster_count() * neighbour_count_);
}

void Clusterer::set_rows(const Rows& rows) {
  rows_ = rows;
  subspaces_ = Subspaces(subspaces_.cluster_count(), padded(rows.stride), 0);
}

void Clusterer::set_labels(std::span<const std::uint32_t> labels) {
  labels_.assign(labels.begin(), labels.end());
  sorted_ = sort_by_cluster(labels_, subspaces_.cluster_count());
}

void Clusterer::grow(std::span<const std::uint32_t> parents,
                     std::span<const std::uint32_t> labels) {
  const std::size_t before = subspaces_.cluster_count(), after = before + parents.size(),
                    width = std::min(kNeighbours, after);
  std::vector<std::uint32_t> other_half(before), found(after * width);
  std::iota(other_half.begin(), other_half.end(), 0u);
  for (std::size_t i = 0; i < parents.size(); ++i) {
    other_half[parents[i]] = static_cast<std::uint32_t>(before + i);
  }
  const auto set = [&](std::uint32_t k, std::uint32_t half, std::uint32_t known) {
    const auto near = std::span(found).subspan(k * width, width);
    std::fill(near.begin(), near.end(), k);
    if (width > 1) near[1] = half;
    const std::size_t first = half == k ? 1 : 2;
    for (std::size_t i = first; i < width && i - first + 1 < neighbour_count_; ++i) {
      near[i] = neighbours_[known * neighbour_count_ + i - first + 1];
    }
  };
  for (std::uint32_t k = 0; k < before; ++k) set(k, other_half[k], k);
  for (const std::uint32_t k : parents) set(other_half[k], k, k);
  neighbours_ = std::move(found);
  subspaces_.resize(after);
  labels_.assign(labels.begin(), labels.end());
  count_clusters();
}

void Clusterer::set_used(std::span<const std::uint32_t> used) {
  std::copy(used.begin(), used.end(), subspaces_.used.begin());
}

void Clusterer::archive(Archive& archive) {
  archive.value(subspaces_.dimension);
  std::size_t capacity = subspaces_.capacity;
  archive.value(capacity);
  archive.array(subspaces_.used);
  archive.array(subspaces_.held);
  if (archive.is_reading()) {
    subspaces_.resize(subspaces_.used.size());
    subspaces_.reserve(capacity);
  }
  for (auto& values : subspaces_.values) archive.array(values);
  for (auto& variances : subspaces_.variances) archive.array(variances);
  archive.array(labels_);
  archive.array(errors_);
  archive.array(neighbours_);
  archive.value(flops_);
  if (archive.is_reading()) count_clusters();
}

/// What follows from how many there are and from the labels.
void Clusterer::count_clusters() {
  neighbour_count_ = std::min(kNeighbours, subspaces_.cluster_count());
  all_clusters_.resize(subspaces_.cluster_count());
  std::iota(all_clusters_.begin(), all_clusters_.end(), 0u);
  sorted_ = sort_by_cluster(labels_, subspaces_.cluster_count());
}

std::vector<Clusterer::Block> Clusterer::make_blocks() const {
  std::vector<Block> blocks;
  for (std::size_t k = 0; k < subspaces_.cluster_count(); ++k) {
    const auto points = sorted_.of(k);
    for (std::size_t done = 0; done < points.size(); done += kClassifyBlock) {
      blocks.push_back({k, points.subspan(done, std::min(kClassifyBlock, points.size() - done))});
    }
  }
  return blocks;
}

Clusterer::Pass Clusterer::classify(bool full, float vector_cost, bool loose) {
  const std::vector<Block> blocks = make_blocks();
  if (full) {
    block_neighbours_.assign(blocks.size() * neighbour_count_, 0);
    block_affinities_.assign(blocks.size() * neighbour_count_, 0.0f);
  }
  if (subspaces_.dimension >= 2 * kLeading) leading_ = find_leading(subspaces_, kLeading);
  std::vector<Classified> classified(blocks.size());
  parallel_for(blocks.size(), 1, [&](std::size_t b, std::size_t) {
    classified[b] = classify_block(blocks[b], full, vector_cost, loose, b);
  });
  leading_.reset();
  if (full) merge_neighbours(blocks);
  Pass pass;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    pass.error_before += classified[b].error_before;
    flops_ += classified[b].flops;
    for (const std::uint32_t p : blocks[b].points)
      pass.moved_count += labels_[p] != blocks[b].cluster;
  }
  sorted_ = sort_by_cluster(labels_, subspaces_.cluster_count());
  if (!loose) pass.moved_count += fill_empty_clusters();
  for (std::size_t p = 0; p < labels_.size(); ++p) {
    pass.error += double{rows_.weight(p)} * double{errors_[p]};
  }
  return pass;
}

Classified Clusterer::classify_block(const Block& block, bool full, float vector_cost, bool loose,
                                     std::size_t number) {
  const auto near =
      std::span(neighbours_).subspan(block.cluster * neighbour_count_, neighbour_count_);
  std::vector<std::uint32_t> candidates =
      full ? all_clusters_ : std::vector<std::uint32_t>(near.begin(), near.end());
  if (full) std::swap(candidates[0], candidates[block.cluster]);
  std::vector<float> affinities(full ? candidates.size() : 0), penalties;
  for (const std::uint32_t k : candidates) {
    penalties.push_back(vector_cost * static_cast<float>(subspaces_.used[k]));
  }
  const std::size_t vector_count = subspaces_.used[block.cluster],
                    point_count = sorted_.of(block.cluster).size();
  const Classified classified =
      cpca::classify(rows_, subspaces_,
                     {.points = block.points,
                      .candidates = candidates,
                      .penalties = penalties,
                      .labels = labels_,
                      .errors = errors_,
                      .affinities = affinities,
                      .own_factor = loose ? own_factor(vector_count, point_count) : 1.0f,
                      .leading = leading_ ? &*leading_ : nullptr});
  if (!full) return classified;
  std::vector<std::uint32_t> order(candidates.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(neighbour_count_);
  std::partial_sort(order.begin(), middle, order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return affinities[a] != affinities[b] ? affinities[a] > affinities[b] : a < b;
  });
  for (std::size_t i = 0; i < neighbour_count_; ++i) {
    block_neighbours_[number * neighbour_count_ + i] = candidates[order[i]];
    block_affinities_[number * neighbour_count_ + i] = affinities[order[i]];
  }
  return classified;
}

void Clusterer::merge_neighbours(std::span<const Block> blocks) {
  std::vector<float> sums(subspaces_.cluster_count());
  std::vector<std::uint32_t> found;
  for (std::size_t b = 0; b < blocks.size();) {
    const std::size_t k = blocks[b].cluster;
    found.assign(1, static_cast<std::uint32_t>(k));
    sums[k] = 1e30f;  // first
    for (; b < blocks.size() && blocks[b].cluster == k; ++b) {
      for (std::size_t i = b * neighbour_count_; i < (b + 1) * neighbour_count_; ++i) {
        const std::uint32_t other = block_neighbours_[i];
        if (sums[other] == 0.0f) found.push_back(other);
        sums[other] += block_affinities_[i];
      }
    }
    std::sort(found.begin(), found.end(), [&](std::uint32_t x, std::uint32_t y) {
      return sums[x] != sums[y] ? sums[x] > sums[y] : x < y;
    });
    for (const std::uint32_t other : found) sums[other] = 0.0f;
    for (std::size_t i = 0; i < neighbour_count_; ++i) {
      neighbours_[k * neighbour_count_ + i] = found[std::min(i, found.size() - 1)];
    }
  }
}

std::size_t Clusterer::fill_empty_clusters() {
  std::vector<std::size_t> left(subspaces_.cluster_count());
  bool any = false;
  for (std::size_t k = 0; k < left.size(); ++k) {
    left[k] = sorted_.of(k).size();
    any = any || left[k] == 0;
  }
  if (!any) return 0;
  std::vector<std::uint32_t> worst(labels_.size());
  std::iota(worst.begin(), worst.end(), 0u);
  const auto weighted = [&](std::uint32_t p) { return rows_.weight(p) * errors_[p]; };
  std::sort(worst.begin(), worst.end(), [&](std::uint32_t a, std::uint32_t b) {
    return weighted(a) != weighted(b) ? weighted(a) > weighted(b) : a < b;
  });
  auto next = worst.begin();
  std::size_t filled_count = 0;
  for (std::size_t k = 0; k < left.size(); ++k) {
    if (left[k] != 0) continue;
    while (next != worst.end() && left[labels_[*next]] <= 1) ++next;
    if (next == worst.end() || weighted(*next) == 0.0f) break;
    --left[labels_[*next]];
    labels_[*next] = static_cast<std::uint32_t>(k);
    subspaces_.used[k] = subspaces_.held[k] = 0;
    for (std::size_t d = 0; d < subspaces_.dimension; ++d) {
      subspaces_.mean(k)[d] = rows_.at(*next, d);
    }
    errors_[*next++] = 0.0f;
    ++filled_count;
    // Its neighbours are those of every cluster until a full pass.
    for (std::size_t i = 0; i < neighbour_count_; ++i) {
      neighbours_[k * neighbour_count_ + i] = static_cast<std::uint32_t>(k);
    }
  }
  sorted_ = sort_by_cluster(labels_, subspaces_.cluster_count());
  return filled_count;
}

void Clusterer::update(std::span<const std::uint32_t> used, std::uint32_t held, int steps) {
  subspaces_.reserve(held);
  parallel_for(subspaces_.cluster_count(), 1, [&](std::size_t k, std::size_t) {
    update_subspace(rows_, sorted_.of(k), errors_, subspaces_, k,
                    {.used = used[k], .held = held, .steps = steps});
  });
  flops_ += 4.0 * steps * static_cast<double>(labels_.size() * subspaces_.dimension) * held;
}

}  // namespace prt::cpca
