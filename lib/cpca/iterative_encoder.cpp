#include <algorithm>

#include "core/progress.h"
#include "cpca/clusterer.h"
#include "cpca/encoder.h"
#include "cpca/fit.h"
#include "cpca/seeding.h"
#include "cpca/stage_clock.h"
#include "cpca/working_space.h"

namespace prt::cpca {

namespace {

/// Power steps after a classification, and for clusters whose vectors start from nothing.
constexpr int kSteps = 2, kFirstSteps = 8;

class IterativeEncoder {
 public:
  IterativeEncoder(std::span<const float> signal, std::size_t dimension, std::vector<float> seeds,
                   const Options& options)
      : options_(options),
        space_(signal, dimension, {}),
        clusterer_(space_.rows(), space_.dimension(), space_.convert(seeds),
                   static_cast<std::size_t>(options.component_count) + 1),
        progress_("encoding",
                  static_cast<std::size_t>(options.iterations) *
                      (static_cast<std::size_t>(options.component_count) + 1),
                  "iterations") {}

  Clusterer run(std::vector<Level>& levels) {
    for (int count = 0; count <= options_.component_count; ++count) {
      if (count > 0) start_level(count, levels.back().errors.back());
      levels.push_back({.component_count = count, .errors = {}});
      run_level(levels.back());
    }
    return std::move(clusterer_);
  }

 private:
  /// One vector more, and one beyond it that is ready when its turn comes.
  void update(int count, int steps) {
    clusterer_.update(static_cast<std::uint32_t>(count), static_cast<std::uint32_t>(count) + 1,
                      steps);
  }

  void start_level(int count, double error) {
    int steps = kSteps;
    if (space_.fit_to(error)) {
      clusterer_.set_rows(space_.rows());
      steps = kFirstSteps;
    }
    clusterer_.set_dimension(space_.dimension());
    update(count, steps);
  }

  void run_level(Level& level) {
    const int count = level.component_count, last = options_.iterations - 1;
    for (int i = 0; i <= last; ++i) {
      // The first pass of all knows no neighbours, not even those of its own result.
      const bool full = i == 0 || (count == 0 && i == 1) ||
                        (count == options_.component_count && i == last) || settled_;
      const Clusterer::Pass pass = clusterer_.classify(full);
      level.errors.push_back(pass.error + space_.tail());
      update(count, kSteps);
      progress_.advance(1);
      settled_ = pass.moved_count == 0;
      if (settled_ && full) break;
    }
    settled_ = false;
  }

  const Options& options_;
  WorkingSpace space_;
  Clusterer clusterer_;
  Progress progress_;
  bool settled_ = false;  ///< nothing moved in the last pass
};

}  // namespace

Encoded encode_iterative(std::span<const float> signal, int dimension, const Options& options) {
  check_options(options);
  check_signal(signal, dimension, options);
  const auto n = static_cast<std::size_t>(dimension);
  const auto cluster_count = static_cast<std::size_t>(options.cluster_count);
  Encoded encoded;
  StageClock clock(encoded.stages);
  std::vector<float> seeds = seed_means(signal, n, cluster_count, options.seed);
  clock.finish("seeding");
  IterativeEncoder encoder(signal, n, std::move(seeds), options);
  clock.finish("axes");
  const Clusterer clusterer = encoder.run(encoded.levels);
  for (const Level& level : encoded.levels) {
    encoded.iterations += static_cast<int>(level.errors.size());
  }
  encoded.flops = clusterer.flops();
  clock.finish("clustering");
  encoded.encoding = {.point_count = signal.size() / n,
                      .dimension = dimension,
                      .cluster_count = options.cluster_count,
                      .component_count = options.component_count,
                      .means = fit_means(signal, n, clusterer.labels(), cluster_count),
                      .bases = {},
                      .cluster_of_point = clusterer.labels(),
                      .weights = {}};
  fit_components(signal, encoded.encoding);
  clock.finish("components");
  return encoded;
}

}  // namespace prt::cpca
