// Quick encodings of a sample: what they tell of the errors of the whole signal, and what they
// cost.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "cpca/iterative_encoder.h"
#include "cpca/method.h"
#include "cpca/search_model.h"
#include "cpca/search_sample.h"

namespace prt::cpca {

/// Encodes the sample, and tells the errors of the whole signal.
class Surveyor {
 public:
  /// Refers to bound and sample.
  Surveyor(const Bound& bound, Method method, const Sample& sample, int dimension,
           const Options& options);

  /// One cluster of all points.
  Column encode_one_of_all(int component_count, std::span<const float> signal,
                           std::span<const float> weights);
  /// One cluster with as many vectors as are within the bound, or bring anything.
  Column encode_one();
  Column encode(int cluster_count);

  /// Whether all points can be looked at for that choice: the fewer there are, the less a sample
  /// tells of many vectors.
  bool can_afford_all(const Choice& one) const;
  /// Whether another column leaves the survey within its share of what is to be encoded.
  bool can_afford(const ErrorModel& model, int cluster_count, const Choice& wanted) const;
  /// Whether clusters may take less than one does: by a column of static encodings, which tells as
  /// much as its errors may be too great by.
  bool may_take_less(ErrorModel model, int cluster_count, const Choice& one);

  bool is_enough(double error) const { return error <= bound_.max_error.value_or(kExact); }
  double flops() const { return flops_; }

 private:
  Column keep(int cluster_count, const std::function<Column()>& make);
  void set_counts(int cluster_count, int component_count);
  int few_vectors() const;
  double work(const Choice& last) const;
  int most_components(int cluster_count) const;
  double correction(std::size_t components) const;
  double relative_error(IterativeEncoder& encoder, double squared_error) const;
  Column measure_one(int component_count, std::span<const float> signal,
                     std::span<const float> weights);
  Column encode_fixed();
  Column encode_iteratively();

  const Bound& bound_;
  const Method method_;
  const Sample& sample_;
  const int dimension_;
  const Size size_;
  const int iterations_;  ///< of the encoding
  Options options_;
  Checkpoint* const checkpoint_;
  std::uint32_t column_count_ = 0;
  std::size_t most_bytes_ = 0;
  double flops_ = 0.0, work_ = 0.0;  ///< done; encoding_work of columns
};

}  // namespace prt::cpca
