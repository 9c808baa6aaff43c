#include "cpca/surveyor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cpca/kept.h"
#include "cpca/one_cluster.h"
#include "cpca/search_cost.h"
#include "cpca/search_survey.h"

namespace prt::cpca {

namespace {

constexpr int kIterations = 4;
/// Of one encoding: what the survey may take before another column.
constexpr double kSurveyBudget = 0.75;
/// Signals of so few points for each coefficient are taken apart as a whole where that takes no
/// more than a share of an encoding.
constexpr std::size_t kPointsPerCoefficient = 8;
constexpr double kShareOfOne = 0.1;
/// By which static encodings of as many clusters and vectors may be worse than iterative ones.
constexpr double kStaticExcess = 2.0;
/// Points of a cluster of the sample per vector and mean.
constexpr double kPointsPerVector = 1.7;

}  // namespace

Surveyor::Surveyor(const Bound& bound, Method method, const Sample& sample, int dimension,
                   const Options& options)
    : bound_(bound),
      method_(method),
      sample_(sample),
      dimension_(dimension),
      size_{sample.all_count, static_cast<std::size_t>(dimension)},
      iterations_(options.iterations),
      options_(options),
      checkpoint_(options.checkpoint) {
  options_.point_weights = sample.point_weights;
  options_.iterations = std::min(options.iterations, kIterations);
  options_.checkpoint = nullptr;  // whole columns are kept
  most_bytes_ = bound.most_bytes(size_);
  if (sample.is_of_rows) {  // clusters of these are exact
    most_bytes_ =
        std::min(most_bytes_, bound.cost.bytes(size_, {static_cast<int>(sample.count), 0}));
  }
}

Column Surveyor::encode_one_of_all(int component_count, std::span<const float> signal,
                                   std::span<const float> weights) {
  return keep(1, [&] { return measure_one(component_count, signal, weights); });
}

Column Surveyor::encode_one() {
  set_counts(1, std::min(most_components(1), kMostWhole));
  return keep(1, [&] {
    const int most = options_.component_count;
    if (method_ != Method::fixed && most > 0) {
      // Together they take no more than so few one by one, and are the same.
      options_.component_count = std::min(most, few_vectors());
      const Column column = encode_iteratively();
      if (is_enough(column.errors.back())) return column;
      options_.component_count = most;
    }
    Column column = measure_one(most, sample_.signal, sample_.point_weights);
    for (std::size_t i = 0; i < column.errors.size(); ++i) column.errors[i] *= correction(i);
    return column;
  });
}

Column Surveyor::encode(int cluster_count) {
  set_counts(cluster_count, most_components(cluster_count));
  const Column column = keep(cluster_count, [&] {
    return method_ == Method::fixed ? encode_fixed() : encode_iteratively();
  });
  work_ += work({cluster_count, static_cast<int>(column.errors.size()) - 1});
  return column;
}

bool Surveyor::can_afford_all(const Choice& one) const {
  const bool is_small = size_.point_count <= kPointsPerCoefficient * size_.dimension;
  return is_small && !sample_.is_all &&
         encoding_work(Method::fixed, size_, one, iterations_) <=
             kShareOfOne * encoding_work(method_, size_, one, iterations_);
}

bool Surveyor::can_afford(const ErrorModel& model, int cluster_count, const Choice& wanted) const {
  Choice last{cluster_count, 0};
  const int most = most_components(cluster_count);
  while (last.component_count < most && !is_enough(model.error(last))) ++last.component_count;
  return work_ + work(last) <= kSurveyBudget * encoding_work(method_, size_, wanted, iterations_);
}

bool Surveyor::may_take_less(ErrorModel model, int cluster_count, const Choice& one) {
  set_counts(cluster_count, most_components(cluster_count));
  model.add(keep(cluster_count, [&] { return encode_fixed(); }));
  Bound loose = bound_;
  loose.max_error = kStaticExcess * bound_.max_error.value_or(kExact);
  for (int i = 0; i <= one.component_count; ++i) {
    auto choice = choose_clusters(model, loose, size_, most_clusters(size_.point_count), i);
    if (!choice) continue;
    choice->cluster_count = std::max(choice->cluster_count, 2);
    if (bound_.cost.bytes(size_, *choice) < bound_.cost.bytes(size_, one)) return true;
  }
  return false;
}

/// Makes a column, or takes the one of an interrupted run.
Column Surveyor::keep(int cluster_count, const std::function<Column()>& make) {
  Column column{cluster_count, {}};
  const Checkpoint::Name name{kSurveyStage, column_count_++};
  const auto members = [&](Archive& archive) {
    archive.array(column.errors);
    archive.value(flops_);
  };
  if (!restore_state(checkpoint_, name, members)) {
    column = make();
    store_state(checkpoint_, name, members);
  }
  for (std::size_t i = 0; i < column.errors.size(); ++i) {
    if (!is_enough(column.errors[i])) continue;
    most_bytes_ =
        std::min(most_bytes_, bound_.cost.bytes(size_, {cluster_count, static_cast<int>(i)}));
  }
  return column;
}

void Surveyor::set_counts(int cluster_count, int component_count) {
  options_.cluster_count = cluster_count;
  options_.component_count = component_count;
}

/// Of one cluster: so many take less one by one than all of them together.
int Surveyor::few_vectors() const {
  const double all = encoding_work(Method::fixed, size_, {1, dimension_}, iterations_);
  int count = 0;
  while (encoding_work(Method::iterative, size_, {1, count + 1}, iterations_) < all) ++count;
  return count;
}

double Surveyor::work(const Choice& last) const {
  const Method method = method_ == Method::fixed ? method_ : Method::iterative;
  return encoding_work(method, {sample_.count, size_.dimension}, last, options_.iterations);
}

/// As many as fit the bytes and the sample has points for.
int Surveyor::most_components(int cluster_count) const {
  int most = bound_.cost.whole(size_).component_count;
  const double points = sample_.points_per_cluster(cluster_count);
  if (!sample_.is_all) {
    most = std::min(most, static_cast<int>(points / kPointsPerVector) - 1);
  }
  while (most > 0 && bound_.cost.bytes(size_, {cluster_count, most}) > most_bytes_) --most;
  return std::max(most, 0);
}

/// From errors of the sample to those of the signal.
double Surveyor::correction(std::size_t components) const {
  if (sample_.is_all) return 1.0;
  const auto taken =
      static_cast<double>((components + 1) * static_cast<std::size_t>(options_.cluster_count));
  return std::sqrt((1.0 - taken / static_cast<double>(sample_.all_count)) /
                   (1.0 - taken / static_cast<double>(sample_.count)));
}

/// Of what the encoder measured last.
double Surveyor::relative_error(IterativeEncoder& encoder, double squared_error) const {
  if (sample_.energy <= 0.0) return 0.0;
  if (bound_.norm == Norm::rmse) return std::sqrt(squared_error / sample_.energy);
  const std::vector<float>& errors = encoder.clusterer().errors();
  double largest = 0.0;
  for (std::size_t p = 0; p < errors.size(); ++p) {
    const double weight = sample_.point_weights.empty() ? 1.0 : double{sample_.point_weights[p]};
    largest = std::max(largest, weight * double{errors[p]});
  }
  return std::sqrt(largest * static_cast<double>(sample_.count) / sample_.energy);
}

Column Surveyor::measure_one(int component_count, std::span<const float> signal,
                             std::span<const float> weights) {
  OneCluster one =
      measure_one_cluster(signal, size_.dimension, component_count, bound_.norm, weights);
  flops_ += one.flops;
  return {1, std::move(one.errors)};
}

Column Surveyor::encode_fixed() {
  const Encoded encoded = encode_static(sample_.signal, dimension_, options_);
  flops_ += encoded.flops;
  const Encoding& encoding = encoded.encoding;
  Column column{encoding.cluster_count,
                relative_errors(encoding, sample_.signal, bound_.norm, sample_.point_weights)};
  for (std::size_t i = 0; i < column.errors.size(); ++i) column.errors[i] *= correction(i);
  return column;
}

Column Surveyor::encode_iteratively() {
  IterativeEncoder encoder(sample_.signal, static_cast<std::size_t>(dimension_), options_);
  Column column{options_.cluster_count, {}};
  for (int i = 0; i <= options_.component_count; ++i) {
    encoder.run_level();
    const double squared_error = encoder.measure();
    column.errors.push_back(relative_error(encoder, squared_error) *
                            correction(static_cast<std::size_t>(i)));
    if (is_enough(column.errors.back())) break;
  }
  flops_ += encoder.clusterer().flops();
  return column;
}

}  // namespace prt::cpca
