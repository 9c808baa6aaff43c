// What encodings cost: the budget of a search.
//
// One encoding, the unit, is what somebody pays who knows the choice that the search will keep, and
// encodes just that, from seeds, to the bound: under the maximum norm tightening is part of it. Its
// products of points with means, vectors and one another are counted (Encoded::flops), seconds only
// reported, so that neither load nor threads change what a search decides (instruction sets may).
// What was not made is told from what was: in proportion to encoding_work().
#pragma once

#include "cpca/method.h"
#include "cpca/search_choice.h"

namespace prt::cpca {

/// Products of an encoding from seeds, as if nothing settled early and no bound ruled anything out.
double encoding_work(Method method, const Size& size, const Choice& choice, int iterations);

/// The same from clusters of another encoding: all vectors at once.
double warm_work(Method method, const Size& size, const Choice& choice, int iterations);

/// From seeds that are all of a few different rows: nothing moves any more.
double equal_rows_work(const Size& size, const Choice& choice);

/// Flops or seconds of a trial.
struct Effort {
  double encoding = 0.0, tightening = 0.0;

  double total() const { return encoding + tightening; }
};

/// Tells what choices cost from the last trial. All in the unit of what learn() is given.
class CostModel {
 public:
  CostModel(Method method, const Size& size, int iterations)
      : method_(method), size_(size), iterations_(iterations) {}

  void learn(const Choice& choice, bool is_warm, const Effort& effort);
  /// Of the choice from seeds to the bound.
  double alone(const Choice& choice) const;
  /// Of the choice as the next trial.
  double next(const Choice& choice, bool is_warm) const;
  /// What a trial would have taken from seeds.
  double alone(const Choice& choice, bool is_warm, const Effort& effort) const;
  /// Products as they are expected before any was learned from.
  double work(const Choice& choice, bool is_warm) const {
    return (is_warm ? warm_work : encoding_work)(method_, size_, choice, iterations_);
  }

 private:
  const Method method_;
  const Size size_;
  const int iterations_;
  double rate_ = 0.0;              ///< effort for each of work, of the last trial from seeds
  double tightening_share_ = 0.0;  ///< of the effort from seeds, in addition
};

}  // namespace prt::cpca
