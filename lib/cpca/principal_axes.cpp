#include "cpca/principal_axes.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "linalg/decompose.h"
#include "linalg/product.h"

namespace prt::cpca {

namespace {

using linalg::Transpose;

constexpr std::size_t kAxesBlock = 512, kAxesColumns = 96;
/// Of the registers that kernels read rows with, at most.
constexpr std::size_t kAxesLanes = 16;
/// Points of the sample for each coefficient.
constexpr std::size_t kSampleShare = 12;

/// Every so many points of a signal.
struct Draw {
  std::span<const float> signal, mean;
  std::size_t step, count;

  /// Some of them, less the mean.
  std::vector<float> rows(std::size_t begin, std::size_t end) const {
    const std::size_t n = mean.size();
    std::vector<float> rows((end - begin) * n);
    for (std::size_t p = begin; p < end; ++p) {
      const float* x = &signal[p * step * n];
      for (std::size_t i = 0; i < n; ++i) rows[(p - begin) * n + i] = x[i] - mean[i];
    }
    return rows;
  }
};

Draw draw_points(std::span<const float> signal, std::span<const float> mean) {
  const std::size_t n = mean.size(), point_count = signal.size() / n;
  const std::size_t step = std::max<std::size_t>(1, point_count / (kSampleShare * n));
  return {signal, mean, step, (point_count + step - 1) / step};
}

std::vector<float> mean_of(std::span<const float> signal, std::size_t n) {
  const std::size_t point_count = signal.size() / n, blocks = block_count(point_count, kAxesBlock);
  std::vector<double> sums(blocks * n);
  parallel_for(point_count, kAxesBlock, [&](std::size_t begin, std::size_t end) {
    double* sum = &sums[begin / kAxesBlock * n];
    for (std::size_t p = begin; p < end; ++p) {
      for (std::size_t i = 0; i < n; ++i) sum[i] += double{signal[p * n + i]};
    }
  });
  std::vector<float> mean(n);
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0.0;
    for (std::size_t b = 0; b < blocks; ++b) sum += sums[b * n + i];
    mean[i] = static_cast<float>(sum / static_cast<double>(point_count));
  }
  return mean;
}

/// Eigenvectors of the covariance of the points: `count` × n.
std::vector<float> find_axes(const Draw& points, std::size_t count) {
  const std::size_t n = points.mean.size();
  std::vector<double> covariance(n * n);
  parallel_for(n, kAxesColumns, [&](std::size_t begin, std::size_t end) {
    std::vector<float> product((end - begin) * (n - begin));
    for (std::size_t done = 0; done < points.count; done += kAxesBlock) {
      const std::size_t some = std::min(kAxesBlock, points.count - done);
      const std::vector<float> rows = points.rows(done, done + some);
      const float* first = rows.data();
      linalg::gemm(1.0f, {first + begin, some, end - begin, n}, Transpose::yes,
                   {first + begin, some, n - begin, n}, Transpose::no, 0.0f,
                   {product.data(), end - begin, n - begin});
      for (std::size_t i = 0; i < end - begin; ++i) {
        double* sum = &covariance[(begin + i) * n + begin];
        for (std::size_t j = 0; j < n - begin; ++j) sum[j] += double{product[i * (n - begin) + j]};
      }
    }
  });
  const auto pairs = linalg::largest_eigenpairs(linalg::MatrixD{covariance.data(), n, n}, count);
  return {pairs.vectors.begin(), pairs.vectors.end()};
}

/// Some points of the signal in the coordinates of the axes, and ‖x - mean‖² of each.
struct Turned {
  std::vector<float> rows;
  std::vector<double> squares;
};

Turned turn(const PrincipalAxes& axes, std::span<const float> points) {
  const std::size_t n = axes.mean.size(), count = axes.axes.size() / n, m = points.size() / n;
  Turned turned{std::vector<float>(m * axes.stride), std::vector<double>(m)};
  std::vector<float> centred(m * n);
  for (std::size_t p = 0; p < m; ++p) {
    for (std::size_t i = 0; i < n; ++i) {
      const float y = points[p * n + i] - axes.mean[i];
      centred[p * n + i] = y;
      turned.squares[p] += double{y} * double{y};
    }
  }
  linalg::gemm(1.0f, {centred.data(), m, n}, Transpose::no, {axes.axes.data(), count, n},
               Transpose::yes, 0.0f, {turned.rows.data(), m, count, axes.stride});
  return turned;
}

/// The greatest number of each coordinate becomes the greatest that 16 bits hold.
std::vector<float> find_scales(const PrincipalAxes& axes, std::span<const float> signal) {
  const std::size_t n = axes.mean.size(), point_count = signal.size() / n;
  std::vector<float> greatest(block_count(point_count, kAxesBlock) * axes.stride);
  parallel_for(point_count, kAxesBlock, [&](std::size_t begin, std::size_t end) {
    float* most = &greatest[begin / kAxesBlock * axes.stride];
    const Turned turned = turn(axes, signal.subspan(begin * n, (end - begin) * n));
    for (std::size_t p = 0; p < end - begin; ++p) {
      const float* row = &turned.rows[p * axes.stride];
      for (std::size_t i = 0; i < axes.stride; ++i) most[i] = std::max(most[i], std::abs(row[i]));
    }
  });
  std::vector<float> scales(axes.stride);
  for (std::size_t i = 0; i < greatest.size(); ++i) {
    float& scale = scales[i % axes.stride];
    scale = std::max(scale, greatest[i] / 32767.0f);
  }
  return scales;
}

/// Rounds the coordinates of the points from `begin` on. Adds to `squares` those of the
/// whole points, then how much of them each coordinate gives.
void round_rows(PrincipalAxes& axes, const Turned& turned, std::size_t begin,
                std::span<const float> weights, double* squares) {
  std::vector<float> inverse(axes.stride);
  for (std::size_t i = 0; i < axes.stride; ++i) {
    inverse[i] = axes.scales[i] > 0.0f ? 1.0f / axes.scales[i] : 0.0f;
  }
  for (std::size_t p = 0; p < turned.squares.size(); ++p) {
    const double weight = weights.empty() ? 1.0 : double{weights[begin + p]};
    squares[0] += weight * turned.squares[p];
    const float* from = &turned.rows[p * axes.stride];
    std::int16_t* to = &axes.rows[(begin + p) * axes.stride];
    for (std::size_t i = 0; i < axes.stride; ++i) {
      const float x = from[i] * inverse[i];
      to[i] =
          static_cast<std::int16_t>(std::clamp(x + std::copysign(0.5f, x), -32767.0f, 32767.0f));
      const double rest = double{from[i]} - double{static_cast<float>(to[i]) * axes.scales[i]};
      squares[1 + i] += weight * (double{from[i]} * double{from[i]} - rest * rest);
    }
  }
}

}  // namespace

PrincipalAxes find_principal_axes(std::span<const float> signal, std::size_t dimension,
                                  std::size_t count, std::span<const float> weights) {
  const std::size_t point_count = signal.size() / dimension;
  PrincipalAxes axes;
  axes.mean = mean_of(signal, dimension);
  axes.axes = find_axes(draw_points(signal, axes.mean), count);
  axes.stride = (count + kAxesLanes - 1) / kAxesLanes * kAxesLanes;
  axes.scales = find_scales(axes, signal);
  axes.rows.resize(point_count * axes.stride);
  const std::size_t width = 1 + axes.stride;
  std::vector<double> squares(block_count(point_count, kAxesBlock) * width), totals(width);
  parallel_for(point_count, kAxesBlock, [&](std::size_t begin, std::size_t end) {
    round_rows(axes, turn(axes, signal.subspan(begin * dimension, (end - begin) * dimension)),
               begin, weights, &squares[begin / kAxesBlock * width]);
  });
  for (std::size_t i = 0; i < squares.size(); ++i) totals[i % width] += squares[i];
  axes.tails.push_back(totals[0]);
  for (std::size_t i = 0; i < count; ++i) {
    axes.tails.push_back(std::max(0.0, axes.tails.back() - totals[1 + i]));
  }
  return axes;
}

std::vector<float> to_axes(const PrincipalAxes& axes, std::span<const float> points) {
  return turn(axes, points).rows;
}

}  // namespace prt::cpca
