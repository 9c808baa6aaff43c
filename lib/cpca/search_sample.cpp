#include "cpca/search_sample.h"

#include <algorithm>

#include "core/parallel.h"
#include "cpca/draw_points.h"
#include "cpca/search_choice.h"

namespace prt::cpca {

namespace {

/// One point of so many is in the sample, but so many at least.
constexpr std::size_t kSurveyShare = 4, kLeastSample = 128;
constexpr std::size_t kCopyBlock = 512;

template <typename Point>
std::vector<float> copy_rows(std::span<const float> signal, std::size_t n,
                             const std::vector<Point>& points) {
  std::vector<float> rows(points.size() * n);
  parallel_for(points.size(), kCopyBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) std::copy_n(&signal[points[s] * n], n, &rows[s * n]);
  });
  return rows;
}

void finish(Sample& sample, std::span<const float> signal, std::span<const float> weights) {
  sample.signal = sample.rows.empty() ? signal : sample.rows;
  sample.point_weights = sample.rows.empty() ? weights : sample.weights;
  sample.energy = weighted_energy(sample.signal, sample.count, sample.point_weights);
}

}  // namespace

std::size_t sample_count(std::size_t point_count) {
  return std::min(point_count, std::max(kLeastSample, point_count / kSurveyShare));
}

Sample make_sample(std::span<const float> signal, std::size_t n, const Options& options) {
  Sample sample;
  sample.all_count = signal.size() / n;
  sample.count = sample_count(sample.all_count);
  sample.is_all = sample.count == sample.all_count;
  if (!sample.is_all) {
    Pcg32 random(options.seed);
    const std::vector<std::size_t> points = draw_points(sample.all_count, sample.count, random);
    sample.rows = copy_rows(signal, n, points);
    if (!options.point_weights.empty()) {
      for (const std::size_t point : points) sample.weights.push_back(options.point_weights[point]);
    }
  }
  finish(sample, signal, options.point_weights);
  return sample;
}

Sample make_sample(std::span<const float> signal, std::size_t n, const Options& options,
                   const EqualRows& rows) {
  Sample sample;
  sample.rows = copy_rows(signal, n, rows.first);
  sample.all_count = rows.labels.size();
  sample.count = rows.first.size();
  sample.is_of_rows = true;
  std::vector<double> sums(sample.count);
  for (std::size_t p = 0; p < sample.all_count; ++p) {
    sums[rows.labels[p]] += options.point_weights.empty() ? 1.0 : double{options.point_weights[p]};
  }
  sample.weights.assign(sums.begin(), sums.end());
  finish(sample, signal, options.point_weights);
  return sample;
}

}  // namespace prt::cpca
