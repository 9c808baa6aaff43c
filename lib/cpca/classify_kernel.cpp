#include <cmath>
#include <vector>

#include "cpca/best_candidate.h"
#include "cpca/subspace_kernels.h"
#include "cpca/subspace_tile.h"

namespace prt::cpca {

namespace {

/// What is lost to rounding in errors, as a share of the squares that they come from.
constexpr float kRounding = 1e-6f;
/// Errors below this share of the squares are found again as squares of residuals.
constexpr float kSmall = 1e-3f;

/// Σ (a - b) c
template <class T>
[[gnu::always_inline]] inline float dot_difference(const float* a, const float* b, const float* c,
                                                   std::size_t count) {
  using Floats = typename T::Floats;
  using Unaligned = typename T::Unaligned;
  Floats sum{};
  for (std::size_t i = 0; i < count; i += T::kLanes) {
    sum +=
        (*reinterpret_cast<const Unaligned*>(a + i) - *reinterpret_cast<const Unaligned*>(b + i)) *
        *reinterpret_cast<const Unaligned*>(c + i);
  }
  return sum_lanes<T>(sum);
}

/// Σ (a - b)²
template <class T>
[[gnu::always_inline]] inline float square_difference(const float* a, const float* b,
                                                      std::size_t count) {
  using Unaligned = typename T::Unaligned;
  typename T::Floats sum{};
  for (std::size_t i = 0; i < count; i += T::kLanes) {
    const typename T::Floats difference =
        *reinterpret_cast<const Unaligned*>(a + i) - *reinterpret_cast<const Unaligned*>(b + i);
    sum += difference * difference;
  }
  return sum_lanes<T>(sum);
}

/// For each candidate ‖d‖², then d·b_i of its vectors.
template <class T>
[[gnu::always_inline]] inline void find_offsets(const Subspaces& subspaces,
                                                std::span<const std::uint32_t> candidates,
                                                float* offsets) {
  const std::size_t count = padded(subspaces.dimension);
  const float* own = subspaces.mean(candidates[0]);
  for (const std::uint32_t k : candidates) {
    const float* mean = subspaces.mean(k);
    *offsets++ = square_difference<T>(mean, own, count);
    for (std::uint32_t i = 0; i < subspaces.used[k]; ++i) {
      *offsets++ = dot_difference<T>(mean, own, subspaces.vector(k, i), count);
    }
  }
}

/// Errors of a panel of points in some subspaces.
template <class T>
struct PanelErrors {
  using Floats = typename T::Floats;
  const Subspaces& subspaces;
  std::span<const std::uint32_t> candidates;
  std::vector<std::size_t> starts;  ///< of each candidate's offsets
  Buffer offsets, products;
  const float* panel = nullptr;
  Floats square[2], own[2];  ///< ‖y‖², and y times the mean that y is relative to
  double flops = 0.0;        ///< of products so far

  [[gnu::always_inline]] PanelErrors(const Subspaces& all,
                                     std::span<const std::uint32_t> candidate_numbers)
      : subspaces(all),
        candidates(candidate_numbers),
        starts(count_starts(all, candidate_numbers)),
        offsets(starts.back()),
        products((1 + all.capacity) * T::kPanel) {
    find_offsets<T>(subspaces, candidates, offsets.get());
  }

  static std::vector<std::size_t> count_starts(const Subspaces& all,
                                               std::span<const std::uint32_t> numbers) {
    std::vector<std::size_t> starts{0};
    for (const std::uint32_t k : numbers) starts.push_back(starts.back() + 1 + all.used[k]);
    return starts;
  }

  /// Finds the errors of the first candidate too. Of `points` lanes flops count.
  [[gnu::always_inline]] void start(const float* coordinates, std::size_t points, Floats* error) {
    panel = coordinates;
    flops_of_row = 2.0 * static_cast<double>(points * subspaces.dimension);
    const auto* y = reinterpret_cast<const Floats*>(panel);
    constexpr std::size_t kSums = 8;  // of which none waits for another
    const std::size_t count = 2 * subspaces.dimension;
    Floats sums[kSums] = {};
    std::size_t i = 0;
    for (; i + kSums <= count; i += kSums) {
#pragma GCC unroll 8
      for (std::size_t j = 0; j < kSums; ++j) sums[j] += y[i + j] * y[i + j];
    }
    for (; i < count; ++i) sums[i % 2] += y[i] * y[i];
    for (std::size_t half = 0; half < 2; ++half) {
      square[half] = (sums[half] + sums[2 + half]) + (sums[4 + half] + sums[6 + half]);
    }
    multiply_by(0);
    const auto* product = reinterpret_cast<const Floats*>(products.get());
    for (int half = 0; half < 2; ++half) own[half] = product[half];
    subtract(0, error);
  }

  [[gnu::always_inline]] void find(std::size_t candidate, Floats* error) {
    multiply_by(candidate);
    subtract(candidate, error);
  }

  /// Of the candidate that was found last: by how much rounding may have changed its errors. Small
  /// ones, where it is most of what differences of squares leave, are found again.
  [[gnu::always_inline]] void refine(std::size_t candidate, Floats* error, Floats* rounding) {
    const float offset = offsets.get()[starts[candidate]];
    typename T::Ints any{};
    for (int half = 0; half < 2; ++half) {
      rounding[half] = kRounding * (square[half] + offset);
      any |= error[half] < kSmall * (square[half] + offset);
    }
    if (!any_lane<T>(any)) return;
    Floats residual[2];
    find_residual(candidate, residual);
    for (int half = 0; half < 2; ++half) {
      const Floats from = square[half] + offset;
      const auto is_small = error[half] < kSmall * from;
      Floats root{};  // a residual r ± δ has the square r² ± 2 r δ
      for (int lane = 0; lane < T::kLanes; ++lane)
        root[lane] = std::sqrt(residual[half][lane] * from[lane]);
      error[half] = is_small ? residual[half] : error[half];
      rounding[half] = is_small ? kRounding * root : rounding[half];
    }
  }

 private:
  double flops_of_row = 0.0;

  [[gnu::always_inline]] void multiply_by(std::size_t candidate) {
    const std::uint32_t k = candidates[candidate];
    multiply<T>(panel, T::kPanel, subspaces.mean(k), subspaces.stride, 1 + subspaces.used[k],
                subspaces.dimension, products.get());
    flops += flops_of_row * (1 + subspaces.used[k]);
  }

  /// ‖y - d - Σ_i (y·b_i - d·b_i) b_i‖² with the products that are there.
  [[gnu::always_inline]] void find_residual(std::size_t candidate, Floats* error) {
    const std::uint32_t k = candidates[candidate], count = subspaces.used[k];
    const float *mean = subspaces.mean(k), *origin = subspaces.mean(candidates[0]);
    const float* offset = offsets.get() + starts[candidate];
    const auto* y = reinterpret_cast<const Floats*>(panel);
    auto* share = reinterpret_cast<Floats*>(products.get());
    for (std::size_t i = 1; i <= count; ++i) {
      for (std::size_t half = 0; half < 2; ++half) share[2 * i + half] -= offset[i];
    }
    error[0] = error[1] = Floats{};
    for (std::size_t d = 0; d < subspaces.dimension; ++d) {
      const float* vector = mean + d;
      Floats rest[2] = {y[2 * d] - (mean[d] - origin[d]), y[2 * d + 1] - (mean[d] - origin[d])};
      for (std::size_t i = 1; i <= count; ++i) {
        vector += subspaces.stride;
        rest[0] -= share[2 * i] * *vector;
        rest[1] -= share[2 * i + 1] * *vector;
      }
      for (int half = 0; half < 2; ++half) error[half] += rest[half] * rest[half];
    }
    flops += flops_of_row * (1 + count);
  }

  [[gnu::always_inline]] void subtract(std::size_t candidate, Floats* error) {
    const auto* product = reinterpret_cast<const Floats*>(products.get());
    const float* offset = offsets.get() + starts[candidate];
    const std::size_t count = subspaces.used[candidates[candidate]];
    for (std::size_t half = 0; half < 2; ++half) {
      Floats sum = square[half] - 2.0f * (product[half] - own[half]) + offset[0];
      for (std::size_t i = 1; i <= count; ++i) {
        const Floats share = product[2 * i + half] - offset[i];
        sum -= share * share;
      }
      error[half] = sum > 0.0f ? sum : Floats{};
    }
  }
};

/// Errors of a panel in each candidate (candidate × kPanel), and the best of each point. Where the
/// leading coordinates show that a candidate is too far, its error is an estimate.
template <class T>
[[gnu::always_inline]] inline void find_best(const Classification& work, PanelErrors<T>& all,
                                             PanelErrors<T>* leading, const float* panel,
                                             const float* point_scales, std::size_t count,
                                             float* errors, Best<T>& best) {
  using Floats = typename T::Floats;
  auto* error = reinterpret_cast<Floats*>(errors);
  const auto* scales = reinterpret_cast<const Floats*>(point_scales);
  Floats beyond[2] = {}, rounding[2] = {};
  all.start(panel, count, error);
  all.refine(0, error, rounding);
  for (int half = 0; half < 2; ++half) {
    best.error[half] = error[half];
    best.cost[half] =
        error[half] * work.own_factor + work.penalties[0] * scales[half] - rounding[half];
    best.candidate[half] = typename T::Ints{};
  }
  if (leading != nullptr) {
    Floats bound[2];
    leading->start(panel, count, bound);
    for (int half = 0; half < 2; ++half) beyond[half] = error[half] - bound[half];
  }
  for (std::size_t c = 1; c < work.candidates.size(); ++c) {
    error += 2;
    if (leading != nullptr) {
      leading->find(c, error);
      const float offset = leading->offsets.get()[leading->starts[c]];
      const Floats margin[2] = {kRounding * (all.square[0] + offset),
                                kRounding * (all.square[1] + offset)};
      if (!best.may_lose_to(error, work.penalties[c], scales, margin)) {
        for (int half = 0; half < 2; ++half) error[half] += beyond[half];
        continue;
      }
    }
    all.find(c, error);
    all.refine(c, error, rounding);
    best.compare(error, work.penalties[c], scales, rounding, c);
  }
}

template <class T, class Source>
[[gnu::always_inline]] inline Classified classify_all(const Source& source, const Rows& rows,
                                                      const Subspaces& subspaces,
                                                      const Classification& work) {
  const std::size_t n = subspaces.dimension;
  Buffer panel(padded(n) * T::kPanel), scales(T::kPanel),
      errors(work.candidates.size() * T::kPanel);
  PanelErrors<T> all(subspaces, work.candidates);
  PanelErrors<T> leading(work.leading != nullptr ? *work.leading : subspaces,
                         work.leading != nullptr ? work.candidates : work.candidates.first(1));
  double error_before = 0.0;
  for (std::size_t done = 0; done < work.points.size(); done += T::kPanel) {
    const auto points =
        work.points.subspan(done, std::min<std::size_t>(T::kPanel, work.points.size() - done));
    transpose<T>(source, subspaces.mean(work.candidates[0]), n, points, panel.get());
    for (std::size_t p = 0; p < T::kPanel; ++p) {
      const float weight = rows.weight(points[std::min(p, points.size() - 1)]);
      scales.get()[p] = weight > 0.0f ? 1.0f / weight : 0.0f;
    }
    Best<T> best;
    find_best<T>(work, all, work.leading != nullptr ? &leading : nullptr, panel.get(), scales.get(),
                 points.size(), errors.get(), best);
    const auto* candidate = reinterpret_cast<const std::int32_t*>(best.candidate);
    const auto* error = reinterpret_cast<const float*>(best.error);
    for (std::size_t p = 0; p < points.size(); ++p) {
      work.labels[points[p]] = work.candidates[static_cast<std::size_t>(candidate[p])];
      work.errors[points[p]] = error[p];
      error_before += double{rows.weight(points[p])} * double{errors.get()[p]};
    }
    if (!work.affinities.empty())
      add_affinities<T>(errors.get(), best, points.size(), work.affinities);
  }
  return {error_before, all.flops + leading.flops};
}

}  // namespace

Classified classify(const Rows& rows, const Subspaces& subspaces, const Classification& work,
                    SimdLevel level) {
  return run_for(
      level, [&](auto tile) __attribute__((always_inline)) {
        using T = decltype(tile);
        return rows.values != nullptr ? classify_all<T>(FloatRows(rows), rows, subspaces, work)
                                      : classify_all<T>(ShortRows(rows), rows, subspaces, work);
      });
}

}  // namespace prt::cpca
