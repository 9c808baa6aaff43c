#include "cpca/encoder.h"
#include "cpca/fit.h"
#include "cpca/quantizer.h"
#include "cpca/seeding.h"
#include "cpca/stage_clock.h"

namespace prt::cpca {

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
      seed_means(signal, n, static_cast<std::size_t>(options.cluster_count), options.seed);
  clock.finish("seeding");
  Clustering clustering =
      quantize(signal, n, std::move(means), options.iterations, options.point_weights);
  encoded.encoding.means = std::move(clustering.means);
  encoded.encoding.cluster_of_point = std::move(clustering.labels);
  encoded.iterations = clustering.iterations;
  clock.finish("clustering");
  fit_components(signal, options.point_weights, encoded.encoding);
  clock.finish("components");
  return encoded;
}

}  // namespace prt::cpca
