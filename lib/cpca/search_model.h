// Predicts errors of encodings from those of a few, and chooses.
//
// The relative error falls about like a power of the number of clusters, whose exponent depends on
// the number of vectors: over a surface, clusters of half the area have a quarter of the squared
// error of a constant, a sixteenth of that of a plane. So log error is interpolated linearly in log
// clusters, for each number of vectors.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cpca/search_choice.h"

namespace prt::cpca {

/// Relative errors no greater are what rounding leaves: less is of no use.
constexpr double kExact = 1e-6;

/// Relative errors for one number of clusters, with no vectors, one, and so on.
struct Column {
  int cluster_count = 0;
  std::vector<double> errors;
};

class ErrorModel {
 public:
  /// In place of one with as many clusters.
  void add(const Column& column);

  double error(const Choice& choice) const;
  /// Vectors of the longest column.
  int most_components() const;

  /// Shifts predictions so that those of the column come true, for as many vectors as it has, and
  /// the rest like its last.
  void correct(const Column& measured);
  /// Shifts all alike, or only those with as many vectors.
  void correct(const Choice& choice, double error);
  void correct_alone(const Choice& choice, double error);

 private:
  /// One cluster, of which a column tells.
  bool is_one(const Choice& choice) const;
  void replace_one(const Column& measured);
  double column_value(std::size_t column, std::size_t components) const;
  double log_error(const Choice& choice) const;

  std::vector<Column> columns_;  // by cluster_count, errors as logarithms
  std::vector<double> shifts_;   // of their logarithms, by number of vectors
  double one_shift_ = 0.0;       // of one cluster
};

/// The least bytes of predicted error <= aim.max_error, the least predicted error within
/// aim.max_bytes, or of exact ones the least bytes; of equal ones that of the lesser error or
/// bytes. When none keeps to max_error, the one of least error. At most `most_clusters`. Throws
/// Error (failed) when nothing is as small as max_bytes.
Choice choose(const ErrorModel& model, const Bound& aim, const Size& size, int most_clusters);

/// The fewest clusters with so many vectors of predicted error <= aim.max_error; nothing if there
/// are none, or the vectors are more than there can be.
std::optional<Choice> choose_clusters(const ErrorModel& model, const Bound& aim, const Size& size,
                                      int most_clusters, int component_count);

/// The most clusters with so many vectors within aim.max_bytes, likewise.
std::optional<Choice> choose_most(const Bound& aim, const Size& size, int most_clusters,
                                  int component_count);

}  // namespace prt::cpca
