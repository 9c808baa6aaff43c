// The clusters of iterative CPCA [Sloan03] §4.2 in the making: what encode_iterative finishes and
// encode_adaptive goes on with.
#pragma once

#include <span>
#include <vector>

#include "core/progress.h"
#include "cpca/clusterer.h"
#include "cpca/encoder.h"
#include "cpca/working_space.h"

namespace prt::cpca {

class IterativeEncoder {
 public:
  /// Seeds the clusters.
  IterativeEncoder(std::span<const float> signal, std::size_t dimension, const Options& options);

  /// Iterates at no vectors, one, up to options.component_count, or only there from a start. Goes
  /// on after the last level that the checkpoint of the options holds.
  std::vector<Level> run();
  /// The next of these levels: no vectors, then one more each time.
  const Level& run_level();
  /// Fits clusters in all coordinates, and returns the squared error. Until the next level that is
  /// where the clusterer is, so that it tells errors of points.
  double measure();

  Clusterer& clusterer() { return clusterer_; }
  const WorkingSpace& space() const { return space_; }
  /// That an interrupted run has done.
  int resumed_iterations() const { return resumed_iterations_; }

 private:
  void archive(Archive& archive);
  void restore();
  void store();
  void update(int count, int steps);
  /// Fits clusters in as many coordinates as an error calls for.
  void update_for(int count, double error);
  /// The level that ends an encoding, of which some iterations are in all coordinates.
  void finish_level(int count);
  void iterate(Level& level, int iterations, bool is_final);
  void move_to(const Rows& rows, std::size_t dimension, int count);
  void move_to_space(int count) { move_to(space_.rows(), space_.dimension(), count); }

  const Options& options_;
  WorkingSpace space_;
  Clusterer clusterer_;
  std::vector<Level> levels_;
  int resumed_iterations_ = 0;
  bool is_away_ = false;  ///< the clusterer is in all coordinates, which are not those of space_
  Progress progress_;
};

}  // namespace prt::cpca
