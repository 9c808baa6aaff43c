// The least encoding within an error, or the best within a size: the search over the number of
// clusters that [Sloan03] §7 leaves to the future.
//
// Static encodings with few iterations are made for a ladder of cluster counts. Each gives the
// errors of all numbers of vectors at once, as every vector takes its share from the error of a
// point. What the actual encoder makes of the choice then says how much better it is than that, and
// the choice is made again, until it stays or three encodings are done.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>

#include "cpca/encoder.h"

namespace prt::cpca {

enum class Norm {
  rmse,    ///< root of the squared error over the energy of the signal
  maximum  ///< root of the largest squared error of a point over the mean energy of a point
};

/// How an encoding will be stored, beside its means and vectors, which are floats. To begin with,
/// as storage_bytes counts.
struct StorageCost {
  std::size_t bytes_per_point = 2;  ///< its cluster, one of 65536 at most
  std::size_t bytes_per_weight = 4;
  std::size_t weight_group = 1;       ///< weights of a point are padded to a multiple of this
  std::size_t bytes_per_cluster = 0;  ///< beside its mean and vectors

  /// Of an encoding in which points have `weight_count` weights in all, clusters `vector_count`.
  std::size_t total(std::size_t point_count, std::size_t weight_count, std::size_t cluster_count,
                    std::size_t vector_count, std::size_t dimension) const {
    return point_count * bytes_per_point + weight_count * bytes_per_weight +
           cluster_count * bytes_per_cluster +
           (cluster_count + vector_count) * dimension * sizeof(float);
  }
};

/// Exactly one of max_error and max_bytes.
struct Bound {
  std::optional<double> max_error;  ///< > 0, relative
  Norm norm = Norm::rmse;
  std::optional<std::size_t> max_bytes;  ///< of what `cost` says
  StorageCost cost = {};
};

using Encoder =
    std::function<Encoded(std::span<const float> signal, int dimension, const Options& options)>;

/// Relative error of an encoding.
double relative_error(const Encoding& encoding, std::span<const float> signal, Norm norm);

/// The encoding of least bytes that keeps to max_error, or of least error that keeps to
/// max_bytes, as far as the search finds it. Counts in `options` are not used. Throws Error
/// (failed) when it finds none.
Encoded encode_within(const Bound& bound, const Encoder& encoder, std::span<const float> signal,
                      int dimension, const Options& options);

}  // namespace prt::cpca
