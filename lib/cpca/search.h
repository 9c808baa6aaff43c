// The least encoding within an error, or the best within a size: the search over the number of
// clusters that [Sloan03] §7 leaves to the future.
//
// A survey of a sample of the points (cpca/search_survey.h) predicts the error of every choice
// (cpca/search_model.h). The best is encoded at full strength. What comes out corrects the
// prediction, and the next encodings, if any, start from seeds or from the clusters of the one
// before. Which these are is up to cpca/search_strategy.h; encodings are made here.
//
// All this takes about three encodings at most, in the unit of cpca/search_cost.h: what the kept
// choice would have taken alone, from seeds to the bound. The survey stops where another number of
// clusters would take more than its share; once something is within the bound, what would lead
// beyond three is not tried.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "cpca/method.h"
#include "cpca/search_choice.h"
#include "cpca/search_trial.h"

namespace prt::cpca {

/// Encodings that a search which may stop is not expected to take more than: a little less than
/// three, as the next one may take more than expected.
constexpr double kBudget = 2.85;

struct Found {
  Encoded encoded;
  std::size_t kept = 0;           ///< the trial that it is
  std::size_t sampled_count = 0;  ///< points of the survey
  std::vector<Trial> trials;
  double seconds = 0.0;  ///< survey and trials
  /// Of the kept choice alone, from seeds to the bound: as measured, or if it started from the
  /// clusters of another, as told from that.
  double alone_seconds = 0.0, alone_flops = 0.0;

  /// How many encodings all took, by seconds, and by products, which machines do not change.
  double cost() const { return seconds / alone_seconds; }
  double flops_cost() const { return encoded.flops / alone_flops; }
};

class Search {
 public:
  /// Counts in `options` are not used. Errors are weighted with its point weights. Throws as
  /// check_options and check_signal.
  Search(Method method, std::span<const float> signal, int dimension, const Options& options);
  ~Search();

  /// The encoding of least bytes that keeps to max_error, or of least error that keeps to
  /// max_bytes, as far as the search finds it. Another call, with a bound that differs little,
  /// knows what the survey and the trials before told: seconds, flops and stages add up, and count
  /// against `budget`, in encodings. Throws Error (failed) when it finds none.
  Found find(const Bound& bound, double budget = kBudget);

  /// Makes seconds, flops and stages of `found` those of all that was done since.
  void add_up(Found& found) const;

  /// Whether another trial, like the last, still leaves it within kBudget encodings of
  /// `found`.
  bool can_afford(const Found& found) const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// Of a search for one bound.
Found encode_within(const Bound& bound, Method method, std::span<const float> signal, int dimension,
                    const Options& options);

}  // namespace prt::cpca
