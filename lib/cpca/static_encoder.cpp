#include <algorithm>
#include <vector>

#include "cpca/encoder.h"
#include "cpca/fit.h"
#include "cpca/quantizer.h"
#include "cpca/seeding.h"
#include "cpca/stage_clock.h"

namespace prt::cpca {

namespace {

/// Of the products of points with means, with one another (the smaller normal form), and with
/// vectors.
double count_flops(const Encoded& encoded) {
  const Encoding& encoding = encoded.encoding;
  const auto n = static_cast<double>(encoding.dimension);
  std::vector<double> sizes(static_cast<std::size_t>(encoding.cluster_count));
  for (const std::uint32_t k : encoding.cluster_of_point) sizes[k] += 1.0;
  double products = static_cast<double>(encoding.point_count) *
                    (encoded.iterations * encoding.cluster_count + encoding.component_count);
  if (encoding.component_count > 0) {
    for (const double size : sizes) products += size * std::min(size, n);
  }
  return 2.0 * n * products;
}

}  // namespace

Encoded encode_static(std::span<const float> signal, int dimension, const Options& options) {
  check_options(options);
  check_signal(signal, dimension, options);
  const auto n = static_cast<std::size_t>(dimension);
  Encoded encoded;
  encoded.encoding.point_count = signal.size() / n;
  encoded.encoding.dimension = dimension;
  encoded.encoding.cluster_count = options.cluster_count;
  encoded.encoding.component_count = options.component_count;
  StageClock clock(encoded.stages);
  std::vector<float> means =
      options.start.labels.empty()
          ? seed_means(signal, n, static_cast<std::size_t>(options.cluster_count), options.seed,
                       options.point_weights)
          : fit_means(signal, n, options.start.labels,
                      static_cast<std::size_t>(options.cluster_count), options.point_weights);
  clock.finish("seeding");
  Clustering clustering =
      quantize(signal, n, std::move(means), options.iterations, options.point_weights,
               options.checkpoint, {options.checkpoint_stage, 0});
  encoded.encoding.means = std::move(clustering.means);
  encoded.encoding.cluster_of_point = std::move(clustering.labels);
  encoded.iterations = clustering.iterations;
  encoded.resumed_iterations = clustering.resumed_iterations;
  clock.finish("clustering");
  fit_components(signal, options.point_weights, encoded.encoding);
  clock.finish("components");
  encoded.flops = count_flops(encoded);
  return encoded;
}

}  // namespace prt::cpca
