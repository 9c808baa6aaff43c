// The least encoding within an error, or the best within a size: the search over the number of
// clusters that [Sloan03] §7 leaves to the future.
//
// A survey of a sample of the points (cpca/search_survey.h) predicts the error of every choice
// (cpca/search_model.h). The best is encoded at full strength. What comes out corrects the
// prediction, and the next encodings, if any, start from the clusters of the one before.
#pragma once

#include <span>
#include <vector>

#include "cpca/method.h"
#include "cpca/search_choice.h"

namespace prt::cpca {

/// An encoding that was made on the way.
struct Trial {
  Choice choice;
  double error = 0.0;       ///< relative, by the norm of the bound
  std::size_t bytes = 0;    ///< by the cost of the bound
  bool is_warm = false;     ///< started from the one before
  double seconds = 0.0;     ///< of whichever run made it
  bool is_resumed = false;  ///< made by an interrupted run
};

struct Found {
  Encoded encoded;
  std::size_t sampled_count = 0;  ///< points of the survey
  std::vector<Trial> trials;
  double seconds = 0.0;  ///< survey and trials
  /// Seconds over those of the last trial that started from seeds: how many encodings all took.
  double cost = 0.0;
  /// The same in products of points with means and vectors, which machines do not change; 0 for
  /// Method::fixed, which does not count them.
  double flops_cost = 0.0;
};

/// The encoding of least bytes that keeps to max_error, or of least error that keeps to
/// max_bytes, as far as the search finds it. Counts in `options` are not used. Errors are weighted
/// with its point weights. Throws Error (failed) when it finds none.
Found encode_within(const Bound& bound, Method method, std::span<const float> signal, int dimension,
                    const Options& options);

}  // namespace prt::cpca
