#include "cpca/search_strategy.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace prt::cpca {

namespace {

/// Trials of one bound until something is within it.
constexpr std::size_t kMostTrials = 12;
/// What another trial must promise: the share of bytes or error that it saves.
constexpr double kWorthwhile = 0.015;
/// Room below max_error at first; after every miss twice as much, a share of what the prediction
/// was off, or kMissDoubt over the root of the sample more, up to the most.
constexpr double kMargin = 0.002, kOffShare = 0.25, kMissDoubt = 0.4, kMostMargin = 0.5;
/// Where nothing is promising, a choice of so much less bytes is tried that would do if the
/// prediction were off by kDoubt over the root of the sample, for each doubling of clusters, and
/// for the least.
constexpr double kProbe = 0.03, kDoubt = 1.0, kLeastDoublings = 0.25;
/// One cluster with that share more bytes than what is predicted to do, and kUncertain over the
/// root of the sample, is certain, and cheap.
constexpr double kCertain = 0.05, kUncertain = 2.0;
/// Clusters of an encoding with that many vectors more or fewer are still a good start.
constexpr int kNearComponents = 2;
/// Under the maximum norm the survey is asked for a root mean square error so many times smaller:
/// the clusters that this takes are where tightening starts.
constexpr double kPeak = 1.8;
/// Of the clusters that tightening is expected to end with, those that it starts with, once a trial
/// has shown how many these are. What it ends with is off by that much: others may be better, and
/// the same from more clusters at first.
constexpr double kFirstShare = 0.65, kLuck = 0.04, kAgainShare = 0.78;
/// Tightening may take that much longer than the last time. What encodings that began with others
/// would take from seeds may be less than is told, as these settle sooner or later.
constexpr double kTightDoubt = 1.35, kToldShare = 0.85;

Bound aim_at(const Bound& bound, double margin) {
  Bound aim = bound;
  if (bound.max_error) {
    *aim.max_error = (1.0 - margin) * *bound.max_error / (bound.is_tight() ? kPeak : 1.0);
  }
  if (bound.is_tight()) aim.norm = Norm::rmse;
  return aim;
}

}  // namespace

Bound first_aim(const Bound& bound) { return aim_at(bound, kMargin); }

Strategy::Strategy(const Bound& bound, double budget, const Size& size, Survey& survey,
                   const CostModel& flops)
    : bound_(bound),
      budget_(budget),
      size_(size),
      most_clusters_(most_clusters(size.point_count)),
      is_tight_(bound.is_tight()),
      survey_(survey),
      flops_(flops),
      margin_(kMargin),
      aim_(first_aim(bound)) {}

std::optional<Step> Strategy::next(double spent) {
  spent_ = spent;
  // Beyond the rounding of floats nothing is more exact.
  const bool is_exact = exact_of(exact_choice()) != Exact::none;
  if (!best_ && bound_.max_error && is_exact && has_tried(exact_choice())) return std::nullopt;
  const std::optional<Choice> choice = choose_next();
  if (!choice) return last_resort();
  const Exact exact = exact_of(*choice);
  if (exact != Exact::none) return exact_step(exact);
  return Step{.choice = *choice,
              .first_cluster_count = first_of(*choice).cluster_count,
              .most_cluster_count = most_clusters_worthwhile(*choice),
              .is_warm = is_warm_start(*choice)};
}

bool Strategy::learn(const Trial& trial, double alone_flops, const std::optional<Column>& column) {
  trials_.push_back(trial);
  const double error = is_tight_ ? trial.error / kPeak : trial.error;
  off_ = std::abs(std::log(std::max(error, 1e-12) / survey_.model.error(trial.choice)));
  if (column) survey_.model.correct(*column);
  if (best_ && !is_tight_) {  // what is known of others stays
    survey_.model.correct_alone(trial.choice, error);
  } else {
    survey_.model.correct(trial.choice, error);
  }
  bytes_share_ = static_cast<double>(trial.bytes) / bytes(trial.choice);
  if (is_within(trial)) {
    const bool is_best = !best_ || worth(trial) < worth(best_trial());
    if (is_best) {
      best_ = trials_.size() - 1;
      best_flops_ = alone_flops;
    }
    return is_best;
  }
  aim_lower();
  return false;
}

bool Strategy::is_within(const Trial& trial) const {
  return bound_.max_error ? trial.error <= *bound_.max_error : trial.bytes <= *bound_.max_bytes;
}

/// What a choice is worth: less is better.
double Strategy::worth(const Trial& trial) const {
  return bound_.max_error ? static_cast<double>(trial.bytes) : trial.error;
}

double Strategy::bytes(const Choice& choice) const {
  return static_cast<double>(bound_.cost.bytes(size_, choice));
}

/// Of different rows no prediction is needed.
Choice Strategy::choose_aim() const {
  const Choice least = choose(survey_.model, aim_, size_, most_clusters_);
  if (!survey_.equal_rows || bytes(exact_choice()) > static_cast<double>(aim_.most_bytes(size_)))
    return least;
  const bool is_within = survey_.model.error(least) <= aim_.max_error.value_or(kExact);
  const double worthwhile = (1.0 - kWorthwhile) * bytes(exact_choice());
  return is_within && bytes(least) < worthwhile ? least : exact_choice();
}

/// Of encodings with the same number of vectors tighten() leaves the clusters that they need.
bool Strategy::is_known(const Choice& choice) const {
  return std::any_of(trials_.begin(), trials_.end(), [&](const Trial& trial) {
    return is_tight_ ? trial.choice.component_count == choice.component_count
                     : trial.choice == choice;
  });
}

void Strategy::aim_lower() {
  const double doubt = kMissDoubt / std::sqrt(static_cast<double>(survey_.sampled_count));
  margin_ = std::min(kMostMargin, std::max({2.0 * margin_, kOffShare * off_, margin_ + doubt}));
  aim_ = aim_at(bound_, margin_);
}

std::optional<Choice> Strategy::choose_next() {
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
Choice Strategy::choose_first() const {
  const Choice least = choose_aim();
  if (!bound_.max_error || least == Choice{1, 0} || exact_of(least) == Exact::equal_rows) {
    return least;
  }
  const auto work = [&](const Choice& choice) { return flops_.work(choice, false); };
  const double most_bytes = bytes(least);
  const double unsure = kUncertain / std::sqrt(static_cast<double>(survey_.sampled_count));
  const double certain = kCertain + (is_tight_ ? 0.0 : unsure);
  const Choice whole = bound_.cost.whole(size_);
  if (exact_of(whole) != Exact::none && bytes(whole) <= (1.0 + certain) * most_bytes) return whole;
  Choice first = least;
  for (int i = 0; i <= static_cast<int>(size_.dimension); ++i) {
    const auto choice = choose_clusters(survey_.model, aim_, size_, most_clusters_, i);
    if (!choice) continue;
    const double share = choice->cluster_count == 1 ? certain : kWorthwhile;
    if (bytes(*choice) > (1.0 + share) * most_bytes) continue;
    if (work(*choice) < work(first)) first = *choice;
  }
  return first;
}

/// What may be better than the best, and affordable: by the prediction, or else if that is off
/// again.
std::optional<Choice> Strategy::choose_better() const {
  if (is_tight_) {
    const std::optional<Choice> beside = choose_beside();
    const auto better = accept(beside, 1.0), again = better ? better : choose_again();
    return again ? again : accept(beside, 1.0 + kLuck);
  }
  const auto better = accept(choose_aim(), 1.0 - kWorthwhile);
  return better ? better : choose_doubtful();
}

/// With up to two vectors fewer or more, and as many clusters as there is room for or as save what
/// is worthwhile, the one that is the likeliest to keep to the bound or to be better, if the
/// prediction may be off by as much: the more, the more the clusters differ, and the smaller the
/// sample.
std::optional<Choice> Strategy::choose_doubtful() const {
  const Choice& best = best_trial().choice;
  const double doubt = kDoubt / std::sqrt(static_cast<double>(survey_.sampled_count));
  const double less = (1.0 - kProbe) * worth(best_trial()),
               max_error = aim_.max_error.value_or(less);
  if (max_error <= kExact) return std::nullopt;
  Bound smaller = aim_;
  if (bound_.max_error) smaller.max_bytes = static_cast<std::size_t>(less / bytes_share_);
  std::optional<Choice> likeliest;
  double least = 0.0;
  for (int i = best.component_count - kNearComponents; i <= best.component_count + kNearComponents;
       ++i) {
    const auto choice = choose_most(smaller, size_, most_clusters_, i);
    if (!choice || is_known(*choice)) continue;
    const double doublings =
        std::abs(std::log2(static_cast<double>(choice->cluster_count) / best.cluster_count));
    const double off =
        std::log(survey_.model.error(*choice) / max_error) - doubt * (kLeastDoublings + doublings);
    if (off >= least || !is_affordable(*choice, is_warm_start(*choice))) continue;
    least = off;
    likeliest = choice;
  }
  return likeliest;
}

/// Nothing, if the choice takes more than `share` of the best, or is not affordable.
std::optional<Choice> Strategy::accept(const std::optional<Choice>& choice, double share) const {
  if (!choice || is_known(*choice)) return std::nullopt;
  // Bytes of adaptive encodings are not quite those of the choice.
  const double expected =
      bound_.max_error ? bytes(*choice) * bytes_share_ : survey_.model.error(*choice);
  if (expected > share * worth(best_trial())) return std::nullopt;
  return is_affordable(*choice, is_warm_start(*choice)) ? choice : std::nullopt;
}

/// With a vector fewer or more than were tightened, the least.
std::optional<Choice> Strategy::choose_beside() const {
  std::optional<Choice> least;
  for (const int step : {-1, 1}) {
    const auto choice = choose_clusters(survey_.model, aim_, size_, most_clusters_,
                                        best_trial().choice.component_count + step);
    if (!choice || is_known(*choice)) continue;
    if (!least || bound_.cost.bytes(size_, *choice) < bound_.cost.bytes(size_, *least))
      least = choice;
  }
  return least;
}

/// The best once more, from other clusters: once, if it took more than it started with.
std::optional<Choice> Strategy::choose_again() const {
  const Choice& best = best_trial().choice;
  const auto count = std::count_if(trials_.begin(), trials_.end(), [&](const Trial& trial) {
    return trial.choice.component_count == best.component_count;
  });
  const bool has_grown = best.cluster_count > best_trial().first_cluster_count;
  return has_grown && count == 1 && is_affordable(best, false) ? std::optional(best) : std::nullopt;
}

/// Clusters as encoded, before they are tightened.
Choice Strategy::first_of(Choice choice) const {
  if (!is_tight_ || trials_.empty()) return choice;
  const double share = is_known(choice) ? kAgainShare : kFirstShare;
  choice.cluster_count = static_cast<int>(std::ceil(share * choice.cluster_count));
  return choice;
}

/// Whether the search is still worth its result, be it this one or the best so far.
bool Strategy::is_affordable(const Choice& choice, bool is_warm) const {
  if (exact_of(choice) == Exact::equal_rows) return true;
  const Choice first = first_of(choice);
  const double doubt = is_tight_ ? kTightDoubt : 1.0;
  const bool is_told = is_warm || best_trial().is_warm;
  double next = flops_.next(first, is_warm);
  // Without vectors encodings settle at another time: what these took tells nothing of others.
  if ((first.component_count == 0) != (trials_.back().choice.component_count == 0)) {
    next = std::max(next, flops_.work(first, is_warm));
  }
  return spent_ + doubt * next <=
         (is_told ? kToldShare : 1.0) * budget_ * std::min(best_flops_, flops_.alone(first));
}

/// Tightened clusters are no good start, but a cheap one.
bool Strategy::is_warm_start(const Choice& choice) const {
  if (trials_.empty()) return false;
  const Choice first = first_of(choice), &from = trials_.back().choice;
  const bool is_near = std::abs(first.component_count - from.component_count) <= kNearComponents &&
                       first.cluster_count <= 2 * from.cluster_count &&
                       from.cluster_count <= 2 * first.cluster_count;
  return is_near && !(is_tight_ && best_ && is_affordable(choice, false));
}

/// More would take more room than is of use, or than what is known.
int Strategy::most_clusters_worthwhile(Choice choice) const {
  const auto most = choose_most(bound_, size_, most_clusters_, choice.component_count);
  if (!best_) return most->cluster_count;
  while (choice.cluster_count < most->cluster_count &&
         bound_.cost.bytes(size_, choice) < best_trial().bytes)
    ++choice.cluster_count;
  return choice.cluster_count;
}

/// One cluster with a vector for every coefficient, where the error is what matters; or one for
/// each different row.
Exact Strategy::exact_of(const Choice& choice) const {
  if (survey_.equal_rows && choice == Choice{survey_.equal_rows->count(), 0}) {
    return Exact::equal_rows;
  }
  const bool is_whole = choice == Choice{1, static_cast<int>(size_.dimension)};
  return is_whole && bound_.max_error ? Exact::one_cluster : Exact::none;
}

/// As exact as it gets, be it with fewer vectors than all.
Choice Strategy::exact_choice() const {
  return survey_.equal_rows ? Choice{survey_.equal_rows->count(), 0} : bound_.cost.whole(size_);
}

bool Strategy::has_tried(const Choice& first) const {
  return std::any_of(trials_.begin(), trials_.end(), [&](const Trial& trial) {
    return Choice{trial.first_cluster_count, trial.choice.component_count} == first;
  });
}

/// Before the error is said to be out of reach.
std::optional<Step> Strategy::last_resort() const {
  if (best_ || !bound_.max_error || has_tried(exact_choice())) return std::nullopt;
  return exact_step(survey_.equal_rows ? Exact::equal_rows : Exact::one_cluster);
}

Step Strategy::exact_step(Exact exact) const {
  const Choice choice = exact == Exact::equal_rows ? exact_choice() : bound_.cost.whole(size_);
  return {.choice = choice,
          .first_cluster_count = choice.cluster_count,
          .most_cluster_count = choice.cluster_count,
          .exact = exact};
}

}  // namespace prt::cpca
