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
#include "cpca/search_cost.h"
#include "cpca/search_resize.h"
#include "cpca/search_survey.h"
#include "cpca/search_trial.h"
#include "cpca/tighten.h"

namespace prt::cpca {

namespace {

/// Trials of one bound until something is within it.
constexpr std::size_t kMostTrials = 12;
/// What another trial must promise: the share of bytes or error that it saves.
constexpr double kWorthwhile = 0.015;
/// Room below max_error at first; after every miss twice as much, and a share of what the
/// prediction was off, up to the most.
constexpr double kMargin = 0.002, kOffShare = 0.25, kMostMargin = 0.5;
/// Where nothing is promising, a choice of so much less bytes is tried that would do if the
/// prediction were off by kDoubt over the root of the sample, for each doubling of clusters, and
/// for the least.
constexpr double kProbe = 0.03, kDoubt = 1.0, kLeastDoublings = 0.25;
/// One cluster with that share more bytes than what is predicted to do is certain, and cheap.
constexpr double kCertain = 0.05;
/// Clusters of an encoding with that many vectors more or fewer are still a good start.
constexpr int kNearComponents = 2;
/// Under the maximum norm the survey is asked for a root mean square error so many times smaller:
/// the clusters that this takes are where tightening starts.
constexpr double kPeak = 1.8;
/// Of the clusters that tightening is expected to end with, those that it starts with, once a trial
/// has shown how many these are. What it ends with is off by that much: others may be better, and
/// the same from more clusters at first.
constexpr double kFirstShare = 0.65, kLuck = 0.04, kAgainShare = 0.78;
/// Tightening may take that much longer than the last time.
constexpr double kTightDoubt = 1.35;

struct Made {
  Encoded encoded;
  Trial trial;
  Effort seconds, flops;
  double alone_seconds = 0.0, alone_flops = 0.0;
};

}  // namespace

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

  Found find(const Bound& bound, double most_cost) {
    const Stopwatch stopwatch;
    most_cost_ = most_cost;
    bound_ = aim_ = bound;
    is_tight_ = bound.max_error && bound.norm == Norm::maximum;
    if (is_tight_) aim_.norm = Norm::rmse;
    margin_ = kMargin;
    trials_.clear();
    set_aim();
    if (!survey_) survey();
    for (std::optional<Choice> next = choose_next(); next; next = choose_next()) {
      make(*next);
      learn();
    }
    seconds_ += stopwatch.seconds();
    const std::shared_ptr<Made> best = std::move(best_);
    const bool is_last = best == last_;
    last_.reset();
    if (!best) reject(bound_, trials_);
    if (!is_last) fit_weights(signal_, best->encoded.encoding);
    Found found{.encoded = std::move(best->encoded),
                .kept = kept_,
                .sampled_count = survey_->sampled_count,
                .trials = std::move(trials_),
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
    return flops_ + last_flops_ <= kMostSearchCost * found.alone_flops;
  }

 private:
  void survey() {
    const Stopwatch stopwatch;
    survey_ = make_survey(aim_, method_, signal_, dimension_, options_);
    flops_ = survey_->flops;
    stages_.push_back({"survey", stopwatch.seconds()});
  }

  bool is_within(const Trial& trial) const {
    return bound_.max_error ? trial.error <= *bound_.max_error : trial.bytes <= *bound_.max_bytes;
  }

  /// What a choice is worth: less is better.
  double worth(const Trial& trial) const {
    return bound_.max_error ? static_cast<double>(trial.bytes) : trial.error;
  }

  Choice choose_aim() const {
    return choose(survey_->model, aim_, size_, most_clusters(size_.point_count));
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
    margin_ = std::min(kMostMargin, std::max(2.0 * margin_, kOffShare * off_));
    set_aim();
  }

  std::optional<Choice> choose_next() {
    if (trials_.size() >= kMostTrials) return std::nullopt;
    if (best_) return choose_better();
    Choice choice = trials_.empty() ? choose_first() : choose_aim();
    // What was tried and missed may look right again after others.
    while (bound_.max_error && is_known(choice) && margin_ < kMostMargin) {
      aim_lower();
      choice = choose_aim();
    }
    return is_known(choice) ? std::nullopt : std::optional(choice);
  }

  /// Of what is about as small as the least the one that takes the least work, should it miss; one
  /// cluster also where it is somewhat larger, as its error is known.
  Choice choose_first() const {
    const Choice least = choose_aim();
    if (!bound_.max_error) return least;
    const auto work = [&](const Choice& choice) {
      return encoding_work(method_, size_, choice, options_.iterations);
    };
    const auto bytes = static_cast<double>(bound_.cost.bytes(size_, least));
    Choice first = least;
    for (int i = 0; i <= static_cast<int>(size_.dimension); ++i) {
      const auto choice =
          choose_clusters(survey_->model, aim_, size_, most_clusters(size_.point_count), i);
      if (!choice) continue;
      const double share = choice->cluster_count == 1 ? kCertain : kWorthwhile;
      if (static_cast<double>(bound_.cost.bytes(size_, *choice)) > (1.0 + share) * bytes) continue;
      if (work(*choice) < work(first)) first = *choice;
    }
    return first;
  }

  /// What may be better than the best, and affordable: by the prediction, or else if that is off
  /// again.
  std::optional<Choice> choose_better() const {
    if (is_tight_) {
      const std::optional<Choice> beside = choose_beside();
      const auto better = accept(beside, 1.0), again = better ? better : choose_again();
      return again ? again : accept(beside, 1.0 + kLuck);
    }
    const auto better = accept(choose_aim(), 1.0 - kWorthwhile);
    if (better || !bound_.max_error) return better;
    return choose_doubtful();
  }

  /// With up to two vectors fewer or more, and as many clusters as save what is worthwhile, the one
  /// that is the likeliest to keep to the bound, if the prediction may be off by as much: the more,
  /// the more the clusters differ, and the smaller the sample.
  std::optional<Choice> choose_doubtful() const {
    const Choice& best = best_->trial.choice;
    const double doubt = kDoubt / std::sqrt(static_cast<double>(survey_->sampled_count));
    Bound smaller = bound_;
    smaller.max_bytes =
        static_cast<std::size_t>((1.0 - kProbe) * worth(best_->trial) / bytes_share_);
    std::optional<Choice> likeliest;
    double least = 0.0;
    for (int i = best.component_count - kNearComponents;
         i <= best.component_count + kNearComponents; ++i) {
      const auto choice = choose_most(smaller, size_, most_clusters(size_.point_count), i);
      if (!choice || is_known(*choice)) continue;
      const double doublings =
          std::abs(std::log2(static_cast<double>(choice->cluster_count) / best.cluster_count));
      const double off = std::log(survey_->model.error(*choice) / *aim_.max_error) -
                         doubt * (kLeastDoublings + doublings);
      if (off >= least || !is_affordable(*choice, is_warm_start(*choice))) continue;
      least = off;
      likeliest = choice;
    }
    return likeliest;
  }

  /// Nothing, if the choice takes more than `share` of the best, or is not affordable.
  std::optional<Choice> accept(const std::optional<Choice>& choice, double share) const {
    if (!choice || is_known(*choice)) return std::nullopt;
    // Bytes of adaptive encodings are not quite those of the choice.
    const double expected =
        bound_.max_error ? static_cast<double>(bound_.cost.bytes(size_, *choice)) * bytes_share_
                         : survey_->model.error(*choice);
    if (expected > share * worth(best_->trial)) return std::nullopt;
    return is_affordable(*choice, is_warm_start(*choice)) ? choice : std::nullopt;
  }

  /// With a vector fewer or more than were tightened, the least.
  std::optional<Choice> choose_beside() const {
    std::optional<Choice> least;
    for (const int step : {-1, 1}) {
      const auto choice =
          choose_clusters(survey_->model, aim_, size_, most_clusters(size_.point_count),
                          best_->trial.choice.component_count + step);
      if (!choice || is_known(*choice)) continue;
      if (!least || bound_.cost.bytes(size_, *choice) < bound_.cost.bytes(size_, *least))
        least = choice;
    }
    return least;
  }

  /// The best once more, from other clusters: once, if it took more than it started with.
  std::optional<Choice> choose_again() const {
    const Choice& best = best_->trial.choice;
    const auto count = std::count_if(trials_.begin(), trials_.end(), [&](const Trial& trial) {
      return trial.choice.component_count == best.component_count;
    });
    const bool has_grown = best.cluster_count > best_->trial.first_clusters;
    return has_grown && count == 1 && is_affordable(best, false) ? std::optional(best)
                                                                 : std::nullopt;
  }

  /// Clusters as encoded, before they are tightened.
  Choice first_of(Choice choice) const {
    if (!is_tight_ || trials_.empty()) return choice;
    const double share = is_known(choice) ? kAgainShare : kFirstShare;
    choice.cluster_count = static_cast<int>(std::ceil(share * choice.cluster_count));
    return choice;
  }

  /// Whether the search is still worth its result, be it this one or the best so far.
  bool is_affordable(const Choice& choice, bool is_warm) const {
    const Choice first = first_of(choice);
    const double doubt = is_tight_ ? kTightDoubt : 1.0;
    return flops_ + doubt * flops_model_.next(first, is_warm) <=
           most_cost_ * std::min(best_->alone_flops, flops_model_.alone(first));
  }

  /// Tightened clusters are no good start, but a cheap one.
  bool is_warm_start(const Choice& choice) const {
    if (!last_) return false;
    const Choice first = first_of(choice), &from = last_->trial.choice;
    const bool is_near =
        std::abs(first.component_count - from.component_count) <= kNearComponents &&
        first.cluster_count <= 2 * from.cluster_count &&
        from.cluster_count <= 2 * first.cluster_count;
    return is_near && !(is_tight_ && best_ && is_affordable(choice, false));
  }

  /// Encodes, from the clusters of the last encoding when these are near.
  void make(const Choice& choice) {
    const Stopwatch stopwatch;
    const Choice first = first_of(choice);
    const bool is_warm = is_warm_start(choice);
    Options options = options_;
    options.cluster_count = first.cluster_count;
    options.component_count = choice.component_count;
    if (options.max_component_count == 0) {
      options.max_component_count =
          std::min(2 * choice.component_count, bound_.cost.max_component_count);
    }
    std::vector<std::uint32_t> labels;
    if (is_warm) {
      const std::vector<double> errors =
          weighted_errors(last_->encoded.encoding, signal_, options_.point_weights);
      labels = resize_clusters(last_->encoded.encoding, errors, options.cluster_count);
      options.start = {labels, std::accumulate(errors.begin(), errors.end(), 0.0)};
    }
    last_.reset();
    // Room for another; fit_weights() knows them. {} would keep the room.
    if (best_) best_->encoded.encoding.weights = std::vector<float>();
    auto made = std::make_shared<Made>();
    made->trial = {.choice = choice, .first_clusters = first.cluster_count, .is_warm = is_warm};
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
      made->encoded = encode(method_, signal_, dimension_, options);
      made->seconds.encoding = stopwatch.seconds();
      made->flops.encoding = made->encoded.flops;
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
    made->seconds.tightening = made->trial.seconds - made->seconds.encoding;
    made->flops.tightening = made->encoded.flops - made->flops.encoding;
    seconds_model_.learn(first, is_warm, made->seconds);
    flops_model_.learn(first, is_warm, made->flops);
    made->alone_seconds = seconds_model_.alone(first, is_warm, made->seconds);
    made->alone_flops = flops_model_.alone(first, is_warm, made->flops);
    last_ = std::move(made);
  }

  void learn() {
    const Trial& trial = last_->trial;
    trials_.push_back(trial);
    log_trial(trial);
    last_flops_ = last_->encoded.flops;
    flops_ += last_flops_;
    const auto& stages = last_->encoded.stages;
    stages_.insert(stages_.end(), stages.begin(), stages.end());
    const double error = is_tight_ ? trial.error / kPeak : trial.error;
    off_ = std::abs(std::log(std::max(error, 1e-12) / survey_->model.error(trial.choice)));
    if (!trial.is_warm) learn_column();
    if (best_ && !is_tight_) {  // what is known of others stays
      survey_->model.correct_alone(trial.choice, error);
    } else {
      survey_->model.correct(trial.choice, error);
    }
    bytes_share_ = static_cast<double>(trial.bytes) /
                   static_cast<double>(bound_.cost.bytes(size_, trial.choice));
    if (is_within(trial)) {
      if (!best_ || worth(trial) < worth(best_->trial)) {
        best_ = last_;
        kept_ = trials_.size() - 1;
      }
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
      survey_->model.correct(
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
    survey_->model.correct(column);
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
  double most_cost_ = kMostSearchCost;
  bool is_tight_ = false;  ///< encodings are tightened to the largest error of a point
  Bound aim_;              ///< what the model is asked for: a little less than the bound
  double margin_ = kMargin;
  double off_ = 0.0;  ///< by which the last prediction was, of the logarithm of the error
  std::shared_ptr<Made> last_, best_;
  std::size_t kept_ = 0;  ///< number of the best
  std::vector<Trial> trials_;
  double bytes_share_ = 1.0;  ///< bytes of the last encoding for each that its choice promised
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

Found Search::find(const Bound& bound, double most_cost) { return state_->find(bound, most_cost); }

void Search::add_up(Found& found) const { state_->add_up(found); }

bool Search::can_afford(const Found& found) const { return state_->can_afford(found); }

Found encode_within(const Bound& bound, Method method, std::span<const float> signal, int dimension,
                    const Options& options) {
  return Search(method, signal, dimension, options).find(bound);
}

}  // namespace prt::cpca
