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

void draw(Sample& sample, std::span<const float> signal, std::size_t n, const Options& options) {
  Pcg32 random(options.seed);
  const std::vector<std::size_t> points = draw_points(sample.all_count, sample.count, random);
  sample.rows.resize(sample.count * n);
  parallel_for(sample.count, kCopyBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      std::copy_n(&signal[points[s] * n], n, &sample.rows[s * n]);
    }
  });
  sample.signal = sample.rows;
  if (options.point_weights.empty()) return;
  for (const std::size_t point : points) sample.weights.push_back(options.point_weights[point]);
  sample.point_weights = sample.weights;
}

}  // namespace

Sample make_sample(std::span<const float> signal, std::size_t n, const Options& options) {
  Sample sample;
  sample.all_count = signal.size() / n;
  sample.count =
      std::min(sample.all_count, std::max(kLeastSample, sample.all_count / kSurveyShare));
  sample.signal = signal;
  sample.point_weights = options.point_weights;
  if (sample.count < sample.all_count) draw(sample, signal, n, options);
  sample.energy = weighted_energy(sample.signal, sample.count, sample.point_weights);
  return sample;
}

}  // namespace prt::cpca
