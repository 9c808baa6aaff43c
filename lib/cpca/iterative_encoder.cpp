#include "cpca/iterative_encoder.h"

#include <algorithm>
#include <limits>

#include "core/log.h"
#include "cpca/fit.h"
#include "cpca/kept.h"
#include "cpca/seeding.h"
#include "cpca/stage_clock.h"

namespace prt::cpca {

namespace {

/// Power steps after a classification, and for clusters whose vectors start from nothing.
constexpr int kLevelSteps = 2, kFirstLevelSteps = 8;
/// Full passes that a level begins with.
constexpr int kFull = 2;
/// Of the last iterations, those in all coordinates where the others knew the first axes only: at
/// most half.
constexpr int kLastIterations = 4;

std::vector<float> first_means(std::span<const float> signal, std::size_t dimension,
                               const Options& options) {
  const auto count = static_cast<std::size_t>(options.cluster_count);
  return options.start.labels.empty()
             ? seed_means(signal, dimension, count, options.seed, options.point_weights)
             : fit_means(signal, dimension, options.start.labels, count, options.point_weights);
}

}  // namespace

IterativeEncoder::IterativeEncoder(std::span<const float> signal, std::size_t dimension,
                                   const Options& options)
    : options_(options),
      // Without vectors clusters are compared as vector quantisation does it.
      space_(signal, dimension, options.point_weights, options.component_count > 0),
      clusterer_(space_.rows(), space_.dimension(),
                 space_.convert(first_means(signal, dimension, options))),
      progress_(
          "encoding",
          static_cast<std::size_t>(options.iterations) *
              (options.start.labels.empty() ? static_cast<std::size_t>(options.component_count) + 1
                                            : 1),
          "iterations") {}

std::vector<Level> IterativeEncoder::run() {
  restore();
  const int last = options_.component_count;
  if (!options_.start.labels.empty()) {
    if (!levels_.empty()) return std::move(levels_);
    clusterer_.set_labels(options_.start.labels);
    space_.fit_to(options_.start.squared_error);
    move_to_space(last);
  } else {
    if (std::ssize(levels_) > last) return std::move(levels_);
    while (std::ssize(levels_) < last) {
      run_level();
      store();
    }
    if (last > 0) update_for(last, levels_.back().errors.back());
  }
  finish_level(last);
  store();
  return std::move(levels_);
}

void IterativeEncoder::archive(Archive& archive) {
  space_.archive(archive);
  if (archive.is_reading()) clusterer_.set_rows(space_.rows());
  clusterer_.archive(archive);
  cpca::archive(archive, levels_);
}

void IterativeEncoder::restore() {
  if (!restore_state(options_.checkpoint, {options_.checkpoint_stage, 0},
                     [&](Archive& from) { archive(from); })) {
    return;
  }
  resumed_iterations_ = iteration_count(levels_);
  progress_.advance(levels_.size() * static_cast<std::size_t>(options_.iterations));
  log::info("continuing an interrupted run, which encoded with {} of {} components",
            levels_.back().component_count, options_.component_count);
}

void IterativeEncoder::store() {
  store_state(options_.checkpoint, {options_.checkpoint_stage, 0},
              [&](Archive& to) { archive(to); });
}

const Level& IterativeEncoder::run_level() {
  const auto count = static_cast<int>(levels_.size());
  if (count > 0) update_for(count, levels_.back().errors.back());
  levels_.push_back({.component_count = count, .errors = {}});
  iterate(levels_.back(), options_.iterations, false);
  return levels_.back();
}

void IterativeEncoder::finish_level(int count) {
  const int last = space_.has_axes() ? std::min(kLastIterations, options_.iterations / 2) : 0;
  levels_.push_back({.component_count = count, .errors = {}});
  iterate(levels_.back(), options_.iterations - last, true);
  if (last == 0) return;
  levels_.back().is_whole = true;
  space_.use_signal();
  move_to_space(count);
  for (int i = 0; i < last; ++i) {
    levels_.back().errors.push_back(clusterer_.classify(false).error);
    update(count, kLevelSteps);
  }
}

double IterativeEncoder::measure() {
  const Level& level = levels_.back();
  if (level.is_whole) return level.errors.back();
  const Rows rows = space_.signal_rows();
  move_to(rows, rows.stride, level.component_count);
  is_away_ = true;
  return clusterer_.classify(false).error;
}

/// One vector more, and one beyond it that is ready when its turn comes.
void IterativeEncoder::update(int count, int steps) {
  const std::vector<std::uint32_t> used(clusterer_.subspaces().cluster_count(),
                                        static_cast<std::uint32_t>(count));
  clusterer_.update(used, static_cast<std::uint32_t>(count) + 1, steps);
}

void IterativeEncoder::update_for(int count, double error) {
  if (space_.fit_to(error) || is_away_) {
    move_to_space(count);
    is_away_ = false;
  } else {
    clusterer_.set_dimension(space_.dimension());
    update(count, kLevelSteps);
  }
}

void IterativeEncoder::move_to(const Rows& rows, std::size_t dimension, int count) {
  clusterer_.set_rows(rows);
  clusterer_.set_dimension(dimension);
  update(count, kFirstLevelSteps);
}

void IterativeEncoder::iterate(Level& level, int iterations, bool is_final) {
  const int count = level.component_count, last = iterations - 1;
  bool settled = false;  // nothing moved in the last pass
  double before = levels_.size() > 1 ? levels_[levels_.size() - 2].errors.back()
                                     : std::numeric_limits<double>::infinity();
  for (int i = 0; i <= last; ++i) {
    // The first pass of all knows no neighbours, not even those of its own result. Of few
    // coefficients and no vectors full passes cost little, and all levels begin with what they
    // find.
    const int full_count = count == 0 && !space_.has_axes() ? iterations : kFull;
    const bool full = settled || i < full_count || (is_final && i == last);
    const bool loose = !settled && i < iterations / 2;
    Clusterer::Pass pass = clusterer_.classify(full, 0.0f, loose);
    if (pass.error + space_.tail() > before) pass = clusterer_.classify(true);
    before = pass.error + space_.tail();
    level.errors.push_back(before);
    level.is_whole = !space_.has_axes();
    if (count == 0) {
      update_for(count, level.errors.back());
    } else {
      update(count, kLevelSteps);
    }
    progress_.advance(1);
    settled = pass.moved_count == 0;
    if (settled && full && !loose) break;
  }
}

Encoded encode_iterative(std::span<const float> signal, int dimension, const Options& options) {
  check_options(options);
  check_signal(signal, dimension, options);
  Encoded encoded;
  std::vector<std::uint32_t> labels;
  StageClock clock(encoded.stages);
  {  // what the encoder holds is gone before weights are made
    IterativeEncoder encoder(signal, static_cast<std::size_t>(dimension), options);
    clock.finish("seeding");
    encoded.levels = encoder.run();
    encoded.flops = encoder.clusterer().flops();
    encoded.resumed_iterations = encoder.resumed_iterations();
    labels = encoder.clusterer().labels();
  }
  encoded.iterations = iteration_count(encoded.levels);
  clock.finish("clustering");
  encoded.encoding = fit(signal, dimension, std::move(labels), options);
  clock.finish("components");
  return encoded;
}

}  // namespace prt::cpca
