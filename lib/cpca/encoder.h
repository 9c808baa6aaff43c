// Encoders of clustered PCA. Vector quantisation alone is static CPCA without components, PCA alone
// is static CPCA with one cluster.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/checkpoint.h"
#include "cpca/encoding.h"

namespace prt::cpca {

/// Where to start from in place of seeds: clusters of an encoding with about as many vectors.
struct Start {
  std::span<const std::uint32_t> labels = {};  ///< cluster of each point; empty: from seeds
  double squared_error = 0.0;  ///< of that encoding; how many coordinates matter depends on it
};

struct Options {
  int cluster_count = 256;  ///< m_c
  int component_count = 8;  ///< n', 0 to the dimension
  int iterations = 20;      ///< of vector quantisation, or for each number of vectors, at most
  std::uint64_t seed = 1;
  int max_component_count = 0;  ///< of a cluster, adaptive; 0: twice component_count
  /// Of each point, finite and >= 0, such as the area around a vertex: errors are weighted with it.
  /// Empty: 1 each.
  std::span<const float> point_weights = {};
  Start start = {};  ///< iterative encoders then begin with all vectors, in one level
  /// Keeps what is done, for a run that continues it: results are of this stage.
  Checkpoint* checkpoint = nullptr;
  std::uint32_t checkpoint_stage = 0;
};

struct Stage {
  std::string name;
  double seconds;
};

/// What iterative encoders did with one number of vectors.
struct Level {
  int component_count = 0;
  /// SE after each iteration; of the last level of encode_adaptive, which is its adaptation, before
  /// each alternation, and larger where the budget is tight.
  std::vector<double> errors;
  /// Whether the last of them are of all coordinates: in axes, subspaces are not quite the best.
  bool is_whole = true;
};

struct Encoded {
  Encoding encoding;
  int iterations = 0;          ///< done
  int resumed_iterations = 0;  ///< of these, by an interrupted run
  std::vector<Level> levels;   ///< of iterative encoders
  double flops = 0.0;  ///< of products of points with means, vectors and one another, as computed
  std::vector<Stage> stages;
};

/// Throws Error (usage) for options that no signal fits: counts below 1 (components: below 0).
void check_options(const Options& options);

/// Throws Error (usage) when there are more clusters than points or more components than
/// coefficients, Error (bad_input) naming the first point that is not finite.
void check_signal(std::span<const float> signal, int dimension, const Options& options);

/// Static CPCA [Sloan03] §4.1: vector quantisation, then PCA in each cluster. `signal` is
/// point_count × dimension. The same signal and options give the same bytes on any number of
/// threads. A cluster with fewer independent points than components gets zero vectors and zero
/// weights for the rest. Checks options and signal as above.
Encoded encode_static(std::span<const float> signal, int dimension, const Options& options);

/// Iterative CPCA [Sloan03] §4.2: points go to the cluster of least approximation error, and each
/// cluster's subspace follows its points, `iterations` times or until nothing moves, for no
/// vectors, then one, up to component_count. From the same seeds as encode_static; likewise
/// otherwise.
Encoded encode_iterative(std::span<const float> signal, int dimension, const Options& options);

/// Adaptive CPCA [Sloan03] §4.3: from the result of encode_iterative, vectors go to the clusters
/// where they save most error for the weights that they cost, Σ_k m_k n'_k <= m_p component_count,
/// up to max_component_count each, and points are classified again, twice `iterations` times. Some
/// of them have a smaller budget, which rearranges the clusters; never worse than encode_iterative.
Encoded encode_adaptive(std::span<const float> signal, int dimension, const Options& options);

}  // namespace prt::cpca
