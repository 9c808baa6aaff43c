#include "cpca/reclassify.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>
#include <tuple>
#include <vector>

#include "core/parallel.h"
#include "cpca/overdraw.h"
#include "cpca/projection.h"

namespace prt::cpca {

namespace {

constexpr std::size_t kReclassifyBlock = 256;

/// The triangles that each point is a corner of, by number, each once.
struct TrianglesOfPoints {
  std::vector<std::size_t> offsets;  // point_count + 1
  std::vector<std::uint32_t> triangles;

  TrianglesOfPoints(std::span<const std::uint32_t> indices, std::size_t point_count)
      : offsets(point_count + 1) {
    const auto for_each_corner = [&](auto visit) {
      for (std::size_t t = 0; t < indices.size() / 3; ++t) {
        for_each_label(indices[3 * t], indices[3 * t + 1], indices[3 * t + 2],
                       [&](std::uint32_t point) { visit(point, static_cast<std::uint32_t>(t)); });
      }
    };
    for_each_corner([&](std::uint32_t point, std::uint32_t) { ++offsets[point + 1]; });
    std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
    triangles.resize(offsets.back());
    std::vector<std::size_t> next = offsets;
    for_each_corner(
        [&](std::uint32_t point, std::uint32_t triangle) { triangles[next[point]++] = triangle; });
  }

  std::span<const std::uint32_t> of(std::uint32_t point) const {
    return std::span(triangles).subspan(offsets[point], offsets[point + 1] - offsets[point]);
  }
};

/// A move as it was when its point had that version; stale once the point has another.
struct Queued {
  Move move;
  std::uint32_t version;
  bool operator<(const Queued& other) const { return is_better(other.move, move); }
};

class Reclassifier {
 public:
  Reclassifier(std::span<const float> signal, std::span<const std::uint32_t> indices,
               const ErrorLimits& limits, Encoding& encoding)
      : signal_(signal),
        indices_(indices),
        limits_(limits),
        encoding_(encoding),
        triangles_(indices, encoding.point_count),
        errors_(weighted_errors(encoding, signal, limits.point_weights)),
        known_errors_(encoding.point_count),
        versions_(encoding.point_count) {}

  Reclassification run(double error_budget) {
    Reclassification result{.initial_error = total_error()};
    room_ = std::min(error_budget * result.initial_error, limits_.total - result.initial_error);
    queue_all();
    while (!queue_.empty()) {
      const auto [move, version] = queue_.top();
      queue_.pop();
      if (version != versions_[move.point]) continue;
      if (move.increase > 0.0 && move.increase > room_) {
        queue(move.point);  // perhaps another cluster fits
        continue;
      }
      apply(move);
      ++result.moved_count;
    }
    result.final_error = total_error();
    return result;
  }

 private:
  double total_error() const { return std::accumulate(errors_.begin(), errors_.end(), 0.0); }

  std::span<const float> row(std::uint32_t point) const {
    const auto n = static_cast<std::size_t>(encoding_.dimension);
    return signal_.subspan(point * n, n);
  }

  int sent_count(std::uint32_t point, std::uint32_t cluster) const {
    int count = 0;
    for (const std::uint32_t t : triangles_.of(point)) {
      const auto label = [&](std::size_t corner) {
        const std::uint32_t other = indices_[3 * t + corner];
        return other == point ? cluster : encoding_.cluster_of_point[other];
      };
      for_each_label(label(0), label(1), label(2), [&](std::uint32_t) { ++count; });
    }
    return count;
  }

  std::vector<std::uint32_t> neighbour_clusters(std::uint32_t point) const {
    std::vector<std::uint32_t> clusters;
    for (const std::uint32_t t : triangles_.of(point)) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        clusters.push_back(encoding_.cluster_of_point[indices_[3 * t + corner]]);
      }
    }
    std::sort(clusters.begin(), clusters.end());
    clusters.erase(std::unique(clusters.begin(), clusters.end()), clusters.end());
    return clusters;
  }

  /// Weighted error of a point in a cluster; remembered, since a point is asked again whenever a
  /// neighbour moves.
  double error_in(std::uint32_t point, std::uint32_t cluster) {
    auto& known = known_errors_[point];
    for (const auto& [known_cluster, error] : known) {
      if (known_cluster == cluster) return error;
    }
    std::vector<float> weights(static_cast<std::size_t>(encoding_.component_count));
    const double error = limits_.weight(point) *
                         project_point(encoding_, static_cast<int>(cluster), row(point), weights);
    known.emplace_back(cluster, error);
    return error;
  }

  /// Of those that there is room for. Points may be asked in parallel.
  std::optional<Move> best_move(std::uint32_t point) {
    std::optional<Move> best;
    const int sent = sent_count(point, encoding_.cluster_of_point[point]);
    for (const std::uint32_t cluster : neighbour_clusters(point)) {
      const int reduction = sent - sent_count(point, cluster);
      if (reduction <= 0) continue;
      const double error = error_in(point, cluster);
      const Move move{point, cluster, reduction, error - errors_[point]};
      if (move.increase > 0.0 && (move.increase > room_ || error > limits_.point)) continue;
      if (!best || is_better(move, *best)) best = move;
    }
    return best;
  }

  void queue_all() {
    std::vector<std::optional<Move>> moves(encoding_.point_count);
    parallel_for(moves.size(), kReclassifyBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) moves[p] = best_move(static_cast<std::uint32_t>(p));
    });
    std::vector<Queued> entries;
    for (const auto& move : moves) {
      if (move) entries.push_back({*move, 0});
    }
    queue_ = std::priority_queue<Queued>({}, std::move(entries));
  }

  void queue(std::uint32_t point) {
    const std::uint32_t version = ++versions_[point];
    if (const auto move = best_move(point)) queue_.push({*move, version});
  }

  void apply(const Move& move) {
    const auto components = static_cast<std::size_t>(encoding_.component_count);
    errors_[move.point] =
        limits_.weight(move.point) *
        project_point(encoding_, static_cast<int>(move.cluster), row(move.point),
                      std::span(encoding_.weights).subspan(move.point * components, components));
    encoding_.cluster_of_point[move.point] = move.cluster;
    room_ -= std::max(move.increase, 0.0);
    std::vector<std::uint32_t> touched;
    for (const std::uint32_t t : triangles_.of(move.point)) {
      touched.insert(touched.end(), &indices_[3 * t], &indices_[3 * t] + 3);
    }
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    for (const std::uint32_t point : touched) queue(point);
  }

  std::span<const float> signal_;
  std::span<const std::uint32_t> indices_;
  const ErrorLimits& limits_;
  Encoding& encoding_;
  TrianglesOfPoints triangles_;
  std::vector<double> errors_;  // of every point where it is
  std::vector<std::vector<std::pair<std::uint32_t, double>>> known_errors_;
  std::vector<std::uint32_t> versions_;
  std::priority_queue<Queued> queue_;
  double room_ = 0.0;
};

}  // namespace

double Move::quotient() const {
  return increase > 0.0 ? reduction / increase : std::numeric_limits<double>::infinity();
}

bool is_better(const Move& a, const Move& b) {
  const auto key = [](const Move& m) {
    return std::tuple(-m.quotient(), -m.reduction, m.increase, m.point, m.cluster);
  };
  return key(a) < key(b);
}

Reclassification reclassify(std::span<const float> signal, std::span<const std::uint32_t> indices,
                            double error_budget, Encoding& encoding, const ErrorLimits& limits) {
  assert(signal.size() == encoding.point_count * static_cast<std::size_t>(encoding.dimension));
  return Reclassifier(signal, indices, limits, encoding).run(error_budget);
}

}  // namespace prt::cpca
