#include "cpca/search.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>

#include "core/log.h"
#include "core/stopwatch.h"
#include "cpca/error_limits.h"
#include "cpca/fit.h"
#include "cpca/kept.h"
#include "cpca/search_cost.h"
#include "cpca/search_resize.h"
#include "cpca/search_strategy.h"
#include "cpca/search_survey.h"
#include "cpca/search_trial.h"
#include "cpca/tighten.h"
#include "cpca/trim.h"

namespace prt::cpca {

class Search::State {
 public:
  State(Method method, std::span<const float> signal, int dimension, const Options& options)
      : method_(method),
        signal_(signal),
        dimension_(dimension),
        options_(options),
        size_{signal.size() / static_cast<std::size_t>(dimension),
              static_cast<std::size_t>(dimension)},
        energy_(weighted_energy(signal, size_.point_count, options.point_weights)),
        seconds_model_(method, size_, options.iterations),
        flops_model_(method, size_, options.iterations) {}

  Found find(const Bound& bound, double budget) {
    const Stopwatch stopwatch;
    bound_ = bound;
    best_.reset();  // of a bound that was out of reach
    last_.reset();
    bound.check_room(size_);
    if (!survey_) survey();
    Strategy strategy(bound, budget, size_, *survey_, flops_model_);
    while (const std::optional<Step> step = strategy.next(flops_)) {
      make(*step);
      log_trial(last_->trial);
      count(last_->encoded);
      if (strategy.learn(last_->trial, last_->alone_flops, told_column(*last_))) best_ = last_;
    }
    seconds_ += stopwatch.seconds();
    const std::shared_ptr<Made> best = std::move(best_);
    const bool is_last = best == last_;
    last_.reset();
    if (!best) reject(bound, strategy.trials());
    if (!is_last) fit_weights(signal_, best->encoded.encoding);
    Found found{.encoded = std::move(best->encoded),
                .kept = *strategy.best(),
                .sampled_count = survey_->sampled_count,
                .trials = strategy.trials(),
                .alone_seconds = best->alone_seconds,
                .alone_flops = best->alone_flops};
    add_up(found);
    return found;
  }

  void add_up(Found& found) const {
    found.seconds = seconds_;
    found.encoded.flops = flops_;
    found.encoded.stages = stages_;
  }

  bool can_afford(const Found& found) const {
    return flops_ + last_flops_ <= kBudget * found.alone_flops;
  }

 private:
  struct Made {
    Encoded encoded;
    Trial trial;
    Effort seconds, flops;
    double alone_seconds = 0.0, alone_flops = 0.0;
  };

  void survey() {
    const Stopwatch stopwatch;
    survey_ = make_survey(first_aim(bound_), method_, signal_, dimension_, options_);
    flops_ = survey_->flops;
    if (survey_->equal_rows) {
      log::info("{} points have {} different rows, for each of which a cluster would be exact",
                size_.point_count, survey_->equal_rows->count());
    }
    stages_.push_back({"survey", stopwatch.seconds()});
  }

  /// Of the next encoding. `labels`: room for where it starts from, the clusters of the last
  /// encoding when these are near.
  Options options_of(const Step& step, std::vector<std::uint32_t>& labels) const {
    Options options = options_;
    options.cluster_count = step.first_cluster_count;
    options.component_count = step.choice.component_count;
    if (options.max_component_count == 0) {
      options.max_component_count =
          std::min(2 * options.component_count, bound_.cost.max_component_count);
    }
    if (step.is_warm) {
      const std::vector<double> errors =
          weighted_errors(last_->encoded.encoding, signal_, options_.point_weights);
      labels = resize_clusters(last_->encoded.encoding, errors, options.cluster_count);
      options.start = {labels, std::accumulate(errors.begin(), errors.end(), 0.0)};
    }
    return options;
  }

  void make(const Step& step) {
    const Stopwatch stopwatch;
    std::vector<std::uint32_t> labels;
    Options options = options_of(step, labels);
    last_.reset();
    // Room for another; fit_weights() knows them. {} would keep the room.
    if (best_) best_->encoded.encoding.weights = std::vector<float>();
    auto made = std::make_shared<Made>();
    made->trial = {.choice = step.choice,
                   .first_cluster_count = step.first_cluster_count,
                   .is_warm = step.is_warm};
    const std::uint32_t number = trial_number_++;
    const auto members = [&](Archive& archive) {
      cpca::archive(archive, made->encoded);
      archive.value(made->trial.seconds);
      archive.value(made->seconds.encoding);
      archive.value(made->flops.encoding);
    };
    made->trial.is_resumed = restore_state(options_.checkpoint, {kTrialStage, number}, members);
    if (made->trial.is_resumed) {
      seconds_ += made->trial.seconds;
    } else {
      options.checkpoint_stage = kEncoderStage + number;
      made->encoded = encode_step(step, options);
      made->seconds.encoding = stopwatch.seconds();
      made->flops.encoding = made->encoded.flops;
      if (bound_.is_tight() && energy_ > 0.0 && step.exact == Exact::none)
        tighten(signal_, point_limit(), step.most_cluster_count, options, made->encoded);
      // Small clusters of adaptive encodings may have more vectors than chosen.
      if (bound_.max_bytes) {
        trim_to_bytes(options.point_weights, bound_.cost, *bound_.max_bytes,
                      made->encoded.encoding);
      }
      made->trial.seconds = stopwatch.seconds();
      store_state(options_.checkpoint, {kTrialStage, number}, members);
      if (options_.checkpoint != nullptr) options_.checkpoint->release(options.checkpoint_stage);
    }
    Encoding& encoding = made->encoded.encoding;
    fit_weights(signal_, encoding);  // to the last bit as they will be found again
    made->trial.error = relative_error(encoding, signal_, bound_.norm, options.point_weights);
    made->trial.bytes = bound_.cost.bytes(encoding);
    made->trial.flops = made->encoded.flops;
    made->trial.choice.cluster_count = encoding.cluster_count;
    made->seconds.tightening = made->trial.seconds - made->seconds.encoding;
    made->flops.tightening = made->encoded.flops - made->flops.encoding;
    learn_cost(step, *made);
    last_ = std::move(made);
  }

  Encoded encode_step(const Step& step, const Options& options) const {
    if (step.exact != Exact::equal_rows) {
      const Method method = step.exact == Exact::one_cluster ? Method::fixed : method_;
      return encode(method, signal_, dimension_, options);
    }
    Options alike = options;
    alike.point_weights = {};  // the same means, also of points that weigh nothing
    Encoded encoded;
    encoded.encoding = fit(signal_, dimension_, survey_->equal_rows->labels, alike);
    encoded.flops = static_cast<double>(signal_.size());  // of the means
    return encoded;
  }

  void learn_cost(const Step& step, Made& made) {
    const Choice first{step.first_cluster_count, step.choice.component_count};
    if (step.exact == Exact::none) {  // others are made otherwise
      seconds_model_.learn(first, step.is_warm, made.seconds);
      flops_model_.learn(first, step.is_warm, made.flops);
    }
    if (step.exact == Exact::equal_rows) {  // it took next to nothing
      made.alone_flops = equal_rows_work(size_, first);
      made.alone_seconds = made.alone_flops * made.seconds.encoding / made.flops.encoding;
      return;
    }
    made.alone_seconds = seconds_model_.alone(first, step.is_warm, made.seconds);
    made.alone_flops = flops_model_.alone(first, step.is_warm, made.flops);
  }

  void count(const Encoded& encoded) {
    last_flops_ = encoded.flops;
    flops_ += last_flops_;
    stages_.insert(stages_.end(), encoded.stages.begin(), encoded.stages.end());
  }

  /// What an encoding tells about fewer vectors: those in levels not of the largest errors, nor of
  /// levels in axes, which are worse than encodings that end there.
  std::optional<Column> told_column(const Made& made) const {
    const int cluster_count = made.trial.choice.cluster_count;
    if (made.trial.is_warm || bound_.is_tight()) return std::nullopt;
    if (made.encoded.levels.empty()) {  // static
      return Column{cluster_count, relative_errors(made.encoded.encoding, signal_, bound_.norm,
                                                   options_.point_weights)};
    }
    if (bound_.norm == Norm::maximum || energy_ <= 0.0) return std::nullopt;
    Column column{cluster_count, {}};
    for (const Level& level : made.encoded.levels) {
      if (!level.is_whole) return std::nullopt;
      column.errors.push_back(std::sqrt(level.errors.back() / energy_));
    }
    // The adaptation is a level of its own.
    column.errors.resize(static_cast<std::size_t>(made.trial.choice.component_count) + 1);
    return column;
  }

  /// Weighted squared error that a point may have.
  double point_limit() const {
    return *bound_.max_error * *bound_.max_error * energy_ / static_cast<double>(size_.point_count);
  }

  const Method method_;
  const std::span<const float> signal_;
  const int dimension_;
  const Options options_;
  const Size size_;
  const double energy_;
  CostModel seconds_model_, flops_model_;
  std::optional<Survey> survey_;
  std::uint32_t trial_number_ = 0;
  std::vector<Stage> stages_;
  double seconds_ = 0.0, flops_ = 0.0, last_flops_ = 0.0;  ///< of all, and of the last trial

  // of one bound
  Bound bound_;
  std::shared_ptr<Made> last_, best_;
};

Search::Search(Method method, std::span<const float> signal, int dimension,
               const Options& options) {
  Options least = options;
  least.cluster_count = 1;
  least.component_count = 0;
  check_options(least);
  check_signal(signal, dimension, least);
  state_ = std::make_unique<State>(method, signal, dimension, options);
}

Search::~Search() = default;

Found Search::find(const Bound& bound, double budget) { return state_->find(bound, budget); }

void Search::add_up(Found& found) const { state_->add_up(found); }

bool Search::can_afford(const Found& found) const { return state_->can_afford(found); }

Found encode_within(const Bound& bound, Method method, std::span<const float> signal, int dimension,
                    const Options& options) {
  return Search(method, signal, dimension, options).find(bound);
}

}  // namespace prt::cpca
