// What a search tries next: from the predictions of the survey, from what the trials before told,
// and within its budget. It sees choices, errors, bytes and flops, no encodings.
#pragma once

#include <optional>
#include <vector>

#include "cpca/search_cost.h"
#include "cpca/search_survey.h"
#include "cpca/search_trial.h"

namespace prt::cpca {

/// Choices that are exact: of any method the same, and not tightened.
enum class Exact {
  none,
  one_cluster,  ///< with all vectors
  equal_rows    ///< a cluster for each different row, without vectors
};

/// The next trial.
struct Step {
  Choice choice;
  int first_cluster_count = 0;  ///< before it is tightened
  int most_cluster_count = 0;   ///< of tightening
  bool is_warm = false;         ///< from the clusters of the last
  Exact exact = Exact::none;
};

/// What a survey is asked for, before anything is known: a little less than the bound.
Bound first_aim(const Bound& bound);

/// For one bound.
class Strategy {
 public:
  /// `survey`, which trials correct, and `flops`, which the caller teaches, are referred to. The
  /// search may take `budget` encodings.
  Strategy(const Bound& bound, double budget, const Size& size, Survey& survey,
           const CostModel& flops);

  /// Nothing when the search is done. `spent`: flops so far.
  std::optional<Step> next(double spent);

  /// What came of it; `alone_flops`: as it would have taken from seeds; `column`: what it tells of
  /// fewer vectors, if anything. Returns whether it is the best within the bound.
  bool learn(const Trial& trial, double alone_flops, const std::optional<Column>& column);

  const std::vector<Trial>& trials() const { return trials_; }
  /// Number of the best, if any is within the bound.
  std::optional<std::size_t> best() const { return best_; }

 private:
  const Trial& best_trial() const { return trials_[*best_]; }
  bool is_within(const Trial& trial) const;
  double worth(const Trial& trial) const;
  double bytes(const Choice& choice) const;
  Choice choose_aim() const;
  bool is_known(const Choice& choice) const;
  void aim_lower();
  std::optional<Choice> choose_next();
  Choice choose_first() const;
  std::optional<Choice> choose_better() const;
  std::optional<Choice> choose_doubtful() const;
  std::optional<Choice> accept(const std::optional<Choice>& choice, double share) const;
  std::optional<Choice> choose_beside() const;
  std::optional<Choice> choose_again() const;
  Exact exact_of(const Choice& choice) const;
  Choice exact_choice() const;
  bool has_tried(const Choice& first) const;
  std::optional<Step> last_resort() const;
  Step exact_step(Exact exact) const;
  Choice first_of(Choice choice) const;
  bool is_affordable(const Choice& choice, bool is_warm) const;
  bool is_warm_start(const Choice& choice) const;
  int most_clusters_worthwhile(Choice choice) const;

  const Bound bound_;
  const double budget_;  ///< of the search, in encodings
  const Size size_;
  const int most_clusters_;
  const bool is_tight_;
  Survey& survey_;
  const CostModel& flops_;
  double margin_;
  Bound aim_;                 ///< what the model is asked for: a little less than the bound
  double spent_ = 0.0;        ///< flops
  double off_ = 0.0;          ///< by which the last prediction was, of the logarithm of the error
  double bytes_share_ = 1.0;  ///< bytes of the last encoding for each that its choice promised
  double best_flops_ = 0.0;   ///< of the best alone
  std::optional<std::size_t> best_;
  std::vector<Trial> trials_;
};

}  // namespace prt::cpca
