#include "cpca/search.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <optional>

#include "core/stopwatch.h"
#include "cpca/error_limits.h"
#include "cpca/fit.h"
#include "cpca/kept.h"
#include "cpca/search_resize.h"
#include "cpca/search_survey.h"
#include "cpca/search_trial.h"
#include "cpca/tighten.h"

namespace prt::cpca {

namespace {

/// Trials until something is within the bound.
constexpr std::size_t kMostTrials = 12;
/// Encodings from seeds that a search with trials that try to do better may take as long as.
constexpr double kMostCost = 3.0;
/// What another trial must promise: the share of bytes or error that it saves.
constexpr double kWorthwhile = 0.015;
/// Room below max_error at first; twice as much after every miss, up to the most.
constexpr double kMargin = 0.002, kMostMargin = 0.5;
/// Clusters of an encoding with that many vectors more or fewer are still a good start.
constexpr int kNearComponents = 2;
/// Under the maximum norm the survey is asked for a root mean square error so many times smaller:
/// the clusters that this takes are where tightening starts.
constexpr double kPeak = 1.8;

bool is_near(const Choice& a, const Choice& b) {
  return std::abs(a.component_count - b.component_count) <= kNearComponents &&
         a.cluster_count <= 2 * b.cluster_count && b.cluster_count <= 2 * a.cluster_count;
}

struct Made {
  Encoded encoded;
  Trial trial;
  double plain_seconds = 0.0, plain_flops = 0.0;  ///< before it was tightened
};

class Search {
 public:
  Search(const Bound& bound, Method method, std::span<const float> signal, int dimension,
         const Options& options)
      : bound_(bound),
        is_tight_(bound.max_error && bound.norm == Norm::maximum),
        aim_(bound),
        method_(method),
        signal_(signal),
        dimension_(dimension),
        options_(options),
        size_{signal.size() / static_cast<std::size_t>(dimension),
              static_cast<std::size_t>(dimension)},
        energy_(weighted_energy(signal, size_.point_count, options.point_weights)) {}

  Found run() {
    survey();
    for (std::optional<Choice> next = choose_next(); next; next = choose_next()) {
      make(*next);
      learn();
    }
    if (!best_) reject(bound_, trials_);
    if (best_ != last_) fit_weights(signal_, best_->encoded.encoding);
    last_.reset();
    Found found{.encoded = std::move(best_->encoded),
                .sampled_count = survey_.sampled_count,
                .trials = std::move(trials_),
                .seconds = stopwatch_.seconds() + resumed_seconds_};
    found.encoded.stages = std::move(stages_);
    found.encoded.flops = flops_;
    found.cost = found.seconds / cold_seconds_;
    if (cold_flops_ > 0.0) found.flops_cost = flops_ / cold_flops_;
    return found;
  }

 private:
  void survey() {
    if (is_tight_) aim_.norm = Norm::rmse;
    set_aim();
    survey_ = make_survey(aim_, method_, signal_, dimension_, options_);
    flops_ = survey_.flops;
    stages_.push_back({"survey", stopwatch_.seconds()});
  }

  bool is_within(const Trial& trial) const {
    return bound_.max_error ? trial.error <= *bound_.max_error : trial.bytes <= *bound_.max_bytes;
  }

  /// What a choice is worth: less is better.
  double worth(const Trial& trial) const {
    return bound_.max_error ? static_cast<double>(trial.bytes) : trial.error;
  }

  Choice choose_aim() const {
    return choose(survey_.model, aim_, size_, most_clusters(size_.point_count));
  }

  /// Of encodings with the same number of vectors tighten() leaves the clusters that they need.
  bool is_known(const Choice& choice) const {
    return std::any_of(trials_.begin(), trials_.end(), [&](const Trial& trial) {
      return is_tight_ ? trial.choice.component_count == choice.component_count
                       : trial.choice == choice;
    });
  }

  void set_aim() {
    if (!bound_.max_error) return;
    aim_.max_error = (1.0 - margin_) * *bound_.max_error / (is_tight_ ? kPeak : 1.0);
  }

  void aim_lower() {
    margin_ = std::min(kMostMargin, 2.0 * margin_);
    set_aim();
  }

  std::optional<Choice> choose_next() {
    if (trials_.size() >= kMostTrials) return std::nullopt;
    Choice choice = choose_aim();
    // What was tried and missed may look right again after others.
    while (!best_ && bound_.max_error && is_known(choice) && margin_ < kMostMargin) {
      aim_lower();
      choice = choose_aim();
    }
    if (!best_) return is_known(choice) ? std::nullopt : std::optional(choice);
    // Bytes of adaptive encodings are not quite those of the choice.
    const double expected =
        bound_.max_error ? static_cast<double>(bound_.cost.bytes(size_, choice)) * bytes_share_
                         : survey_.model.error(choice);
    if (is_known(choice) || expected > (1.0 - kWorthwhile) * worth(best_->trial))
      return std::nullopt;
    return cost_with(choice) > kMostCost ? std::nullopt : std::optional(choice);
  }

  /// Of the search so far and another trial, in encodings from seeds. With i vectors that is 1 + 2
  /// + … + (i + 1) times the work of vector quantisation, of which warm ones do the last part.
  double cost_with(const Choice& choice) const {
    const bool is_warm = is_near(choice, last_->trial.choice);
    const double share = is_warm ? 2.0 / (choice.component_count + 2) : 1.0;
    return share +
           (cold_flops_ > 0.0 ? flops_ / cold_flops_ : static_cast<double>(trials_.size()) + 1.0);
  }

  /// Encodes, from the clusters of the last encoding when these are near.
  void make(const Choice& choice) {
    const Stopwatch stopwatch;
    Options options = options_;
    options.cluster_count = choice.cluster_count;
    options.component_count = choice.component_count;
    if (options.max_component_count == 0) {
      options.max_component_count =
          std::min(2 * choice.component_count, bound_.cost.max_component_count);
    }
    std::vector<std::uint32_t> labels;
    const bool is_warm = last_ && is_near(choice, last_->trial.choice);
    if (is_warm) {
      const std::vector<double> errors =
          weighted_errors(last_->encoded.encoding, signal_, options_.point_weights);
      labels = resize_clusters(last_->encoded.encoding, errors, options.cluster_count);
      options.start = {labels, std::accumulate(errors.begin(), errors.end(), 0.0)};
    }
    last_.reset();
    if (best_) best_->encoded.encoding.weights = {};  // room for another; fit_weights() knows them
    auto made = std::make_shared<Made>();
    made->trial = {.choice = choice, .is_warm = is_warm};
    const auto number = static_cast<std::uint32_t>(trials_.size());
    const auto members = [&](Archive& archive) {
      cpca::archive(archive, made->encoded);
      archive.value(made->trial.seconds);
      archive.value(made->plain_seconds);
      archive.value(made->plain_flops);
    };
    made->trial.is_resumed = restore_state(options_.checkpoint, {kTrialStage, number}, members);
    if (made->trial.is_resumed) {
      resumed_seconds_ += made->trial.seconds;
    } else {
      options.checkpoint_stage = kEncoderStage + number;
      made->encoded = encode(method_, signal_, dimension_, options);
      made->plain_seconds = stopwatch.seconds();
      made->plain_flops = made->encoded.flops;
      if (is_tight_ && energy_ > 0.0)
        tighten(signal_, point_limit(), most_clusters_worthwhile(choice), options, made->encoded);
      made->trial.seconds = stopwatch.seconds();
      store_state(options_.checkpoint, {kTrialStage, number}, members);
      if (options_.checkpoint != nullptr) options_.checkpoint->release(options.checkpoint_stage);
    }
    Encoding& encoding = made->encoded.encoding;
    fit_weights(signal_, encoding);  // to the last bit as they will be found again
    made->trial.error = relative_error(encoding, signal_, bound_.norm, options.point_weights);
    made->trial.bytes = bound_.cost.bytes(encoding);
    made->trial.choice.cluster_count = encoding.cluster_count;
    last_ = std::move(made);
  }

  void learn() {
    const Trial& trial = last_->trial;
    trials_.push_back(trial);
    log_trial(trial);
    flops_ += last_->encoded.flops;
    const auto& stages = last_->encoded.stages;
    stages_.insert(stages_.end(), stages.begin(), stages.end());
    if (!trial.is_warm) {
      cold_seconds_ = last_->plain_seconds;
      cold_flops_ = last_->plain_flops;
      learn_column();
    }
    survey_.model.correct(trial.choice, is_tight_ ? trial.error / kPeak : trial.error);
    bytes_share_ = static_cast<double>(trial.bytes) /
                   static_cast<double>(bound_.cost.bytes(size_, trial.choice));
    if (is_within(trial)) {
      if (!best_ || worth(trial) < worth(best_->trial)) best_ = last_;
    } else if (bound_.max_error) {
      aim_lower();
    } else {
      // Small clusters of adaptive encodings have more vectors than chosen.
      const double share =
          static_cast<double>(*bound_.max_bytes) / static_cast<double>(trial.bytes);
      *aim_.max_bytes =
          static_cast<std::size_t>(0.98 * share * static_cast<double>(*aim_.max_bytes));
    }
  }

  /// What an encoding tells about fewer vectors: iterative ones not of the largest errors, nor of
  /// levels in axes, which are worse than encodings that end there.
  void learn_column() {
    if (is_tight_) return;
    if (method_ == Method::fixed) {
      survey_.model.correct(
          {last_->trial.choice.cluster_count,
           relative_errors(last_->encoded.encoding, signal_, bound_.norm, options_.point_weights)});
      return;
    }
    if (bound_.norm == Norm::maximum || energy_ <= 0.0) return;
    Column column{last_->trial.choice.cluster_count, {}};
    for (const Level& level : last_->encoded.levels) {
      if (!level.is_whole) return;
      column.errors.push_back(std::sqrt(level.errors.back() / energy_));
    }
    // The adaptation is a level of its own.
    column.errors.resize(static_cast<std::size_t>(last_->trial.choice.component_count) + 1);
    survey_.model.correct(column);
  }

  /// Weighted squared error that a point may have.
  double point_limit() const {
    return *bound_.max_error * *bound_.max_error * energy_ / static_cast<double>(size_.point_count);
  }

  /// More would take more room than what is known.
  int most_clusters_worthwhile(Choice choice) const {
    const int most = most_clusters(size_.point_count);
    if (!best_) return most;
    while (choice.cluster_count < most && bound_.cost.bytes(size_, choice) < best_->trial.bytes)
      ++choice.cluster_count;
    return choice.cluster_count;
  }

  const Bound bound_;
  const bool is_tight_;  ///< encodings are tightened to the largest error of a point
  Bound aim_;            ///< what the model is asked for: a little less than the bound
  const Method method_;
  const std::span<const float> signal_;
  const int dimension_;
  const Options options_;
  const Size size_;
  const double energy_;
  const Stopwatch stopwatch_;
  double margin_ = kMargin;
  Survey survey_;
  std::shared_ptr<Made> last_, best_;
  std::vector<Trial> trials_;
  double bytes_share_ = 1.0;  ///< bytes of the last encoding for each that its choice promised
  std::vector<Stage> stages_;
  double flops_ = 0.0, cold_flops_ = 0.0, cold_seconds_ = 0.0, resumed_seconds_ = 0.0;
};

}  // namespace

Found encode_within(const Bound& bound, Method method, std::span<const float> signal, int dimension,
                    const Options& options) {
  Options least = options;
  least.cluster_count = 1;
  least.component_count = 0;
  check_options(least);
  check_signal(signal, dimension, least);
  return Search(bound, method, signal, dimension, options).run();
}

}  // namespace prt::cpca
