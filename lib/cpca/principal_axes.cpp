#include "cpca/principal_axes.h"

#include <algorithm>

#include "core/parallel.h"
#include "linalg/decompose.h"
#include "linalg/product.h"

namespace prt::cpca {

namespace {

using linalg::Transpose;

constexpr std::size_t kBlock = 512, kColumnBlock = 96;
/// Points of the sample for each coefficient.
constexpr std::size_t kSampleShare = 12;

/// Every so many points: rows less the mean.
std::vector<float> draw_rows(std::span<const float> signal, std::span<const float> mean,
                             std::size_t step) {
  const std::size_t n = mean.size(), count = (signal.size() / n + step - 1) / step;
  std::vector<float> rows(count * n);
  parallel_for(count, kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const float* x = &signal[p * step * n];
      for (std::size_t i = 0; i < n; ++i) rows[p * n + i] = x[i] - mean[i];
    }
  });
  return rows;
}

std::vector<float> mean_of(std::span<const float> signal, std::size_t n) {
  const std::size_t point_count = signal.size() / n, blocks = block_count(point_count, kBlock);
  std::vector<double> sums(blocks * n);
  parallel_for(point_count, kBlock, [&](std::size_t begin, std::size_t end) {
    double* sum = &sums[begin / kBlock * n];
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

/// Eigenvectors of the covariance of the rows: `count` × n.
std::vector<float> find_axes(std::span<const float> rows, std::size_t n, std::size_t count) {
  const std::size_t row_count = rows.size() / n;
  std::vector<double> covariance(n * n);
  parallel_for(n, kColumnBlock, [&](std::size_t begin, std::size_t end) {
    std::vector<float> product((end - begin) * (n - begin));
    for (std::size_t done = 0; done < row_count; done += kBlock) {
      const std::size_t some = std::min(kBlock, row_count - done);
      const float* first = &rows[done * n];
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

/// Turns rows (from `begin` on) of the signal, and adds their squares to `squares`: of the whole
/// row, then of each coordinate.
void turn_block(PrincipalAxes& axes, std::span<const float> signal, std::size_t begin,
                std::size_t end, std::span<const float> weights, double* squares) {
  const std::size_t n = axes.mean.size(), count = axes.axes.size() / n, m = end - begin;
  std::vector<float> centred(m * n);
  for (std::size_t p = 0; p < m; ++p) {
    const float* x = &signal[(begin + p) * n];
    double square = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      centred[p * n + i] = x[i] - axes.mean[i];
      square += double{centred[p * n + i]} * double{centred[p * n + i]};
    }
    squares[0] += square * (weights.empty() ? 1.0 : double{weights[begin + p]});
  }
  float* rows = &axes.rows[begin * count];
  linalg::gemm(1.0f, {centred.data(), m, n}, Transpose::no, {axes.axes.data(), count, n},
               Transpose::yes, 0.0f, {rows, m, count});
  for (std::size_t p = 0; p < m; ++p) {
    const double weight = weights.empty() ? 1.0 : double{weights[begin + p]};
    for (std::size_t i = 0; i < count; ++i) {
      const double value = rows[p * count + i];
      squares[1 + i] += weight * value * value;
    }
  }
}

}  // namespace

PrincipalAxes find_principal_axes(std::span<const float> signal, std::size_t dimension,
                                  std::size_t count, std::span<const float> weights) {
  const std::size_t point_count = signal.size() / dimension;
  PrincipalAxes axes;
  axes.mean = mean_of(signal, dimension);
  const std::size_t step = std::max<std::size_t>(1, point_count / (kSampleShare * dimension));
  axes.axes = find_axes(draw_rows(signal, axes.mean, step), dimension, count);
  axes.rows.resize(point_count * count);
  std::vector<double> squares(block_count(point_count, kBlock) * (1 + count));
  parallel_for(point_count, kBlock, [&](std::size_t begin, std::size_t end) {
    turn_block(axes, signal, begin, end, weights, &squares[begin / kBlock * (1 + count)]);
  });
  std::vector<double> totals(1 + count);
  for (std::size_t i = 0; i < squares.size(); ++i) totals[i % (1 + count)] += squares[i];
  axes.tails.push_back(totals[0]);
  for (std::size_t i = 0; i < count; ++i) {
    axes.tails.push_back(std::max(0.0, axes.tails.back() - totals[1 + i]));
  }
  return axes;
}

std::vector<float> to_axes(const PrincipalAxes& axes, std::span<const float> points) {
  const std::size_t n = axes.mean.size(), point_count = points.size() / n, count = axes.count();
  const std::vector<float> centred = draw_rows(points, axes.mean, 1);
  std::vector<float> turned(point_count * count);
  linalg::gemm(1.0f, {centred.data(), point_count, n}, Transpose::no, {axes.axes.data(), count, n},
               Transpose::yes, 0.0f, {turned.data(), point_count, count});
  return turned;
}

}  // namespace prt::cpca
