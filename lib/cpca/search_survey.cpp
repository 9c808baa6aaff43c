#include "cpca/search_survey.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/parallel.h"
#include "core/random.h"
#include "cpca/iterative_encoder.h"
#include "cpca/kept.h"
#include "cpca/search_cost.h"

namespace prt::cpca {

namespace {

constexpr int kIterations = 4, kStep = 4, kMostColumns = 4;
/// One point of so many is in the sample, but so many at least.
constexpr std::size_t kSurveyShare = 4, kLeastSample = 128;
/// Of one encoding: what the survey may take before another column.
constexpr double kMostCost = 0.75;
/// More coefficients than that are not taken apart for one cluster with all vectors: eigenvectors
/// take the cube of them.
constexpr int kMostWhole = 256;
/// Points of a cluster of the sample, at least; and per vector and mean.
constexpr std::size_t kPointsPerCluster = 6;
constexpr double kPointsPerVector = 1.7;
constexpr std::size_t kMostClusters = 65536, kSignalPointsPerCluster = 2, kCopyBlock = 512;

struct Sample {
  std::vector<float> rows, weights;  ///< empty: all points
  std::span<const float> signal, point_weights;
  std::size_t count = 0, all_count = 0;
  double energy = 0.0;

  double points_per_cluster(int cluster_count) const {
    return static_cast<double>(count) / cluster_count;
  }
};

/// One point out of each of equally long stretches of the signal.
void draw(Sample& sample, std::span<const float> signal, std::size_t n, const Options& options) {
  Pcg32 random(options.seed);
  std::vector<std::size_t> points(sample.count);
  for (std::size_t s = 0; s < sample.count; ++s) {
    const std::size_t begin = s * sample.all_count / sample.count;
    const std::size_t length = (s + 1) * sample.all_count / sample.count - begin;
    points[s] = begin + random.below(static_cast<std::uint32_t>(length));
  }
  sample.rows.resize(sample.count * n);
  parallel_for(sample.count, kCopyBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      std::copy_n(&signal[points[s] * n], n, &sample.rows[s * n]);
    }
  });
  sample.signal = sample.rows;
  if (options.point_weights.empty()) return;
  for (const std::size_t point : points) sample.weights.push_back(options.point_weights[point]);
  sample.point_weights = sample.weights;
}

Sample make_sample(std::span<const float> signal, std::size_t n, const Options& options) {
  Sample sample;
  sample.all_count = signal.size() / n;
  sample.count =
      std::min(sample.all_count, std::max(kLeastSample, sample.all_count / kSurveyShare));
  sample.signal = signal;
  sample.point_weights = options.point_weights;
  if (sample.count < sample.all_count) draw(sample, signal, n, options);
  sample.energy = weighted_energy(sample.signal, sample.count, sample.point_weights);
  return sample;
}

/// Encodes the sample, and tells the errors of the whole signal.
class Surveyor {
 public:
  Surveyor(const Bound& bound, Method method, const Sample& sample, int dimension,
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
  }

  Column encode(int cluster_count) {
    options_.cluster_count = cluster_count;
    options_.component_count = most_components(cluster_count);
    Column column{cluster_count, {}};
    const Checkpoint::Name name{kSurveyStage, column_count_++};
    const auto members = [&](Archive& archive) {
      archive.array(column.errors);
      archive.value(flops_);
    };
    if (!restore_state(checkpoint_, name, members)) {
      // Of one cluster the static method makes the same.
      const bool is_fixed = method_ == Method::fixed || cluster_count == 1;
      column = is_fixed ? encode_fixed() : encode_iteratively();
      store_state(checkpoint_, name, members);
    }
    const Choice last{cluster_count, static_cast<int>(column.errors.size()) - 1};
    if (cluster_count > 1) work_ += work(last);
    for (std::size_t i = 0; bound_.max_error && i < column.errors.size(); ++i) {
      if (column.errors[i] > *bound_.max_error) continue;
      most_bytes_ =
          std::min(most_bytes_, bound_.cost.bytes(size_, {cluster_count, static_cast<int>(i)}));
    }
    return column;
  }

  double flops() const { return flops_; }

  /// Whether another column leaves the survey within its share of what is to be encoded.
  bool can_afford(const ErrorModel& model, int cluster_count, const Choice& wanted) const {
    Choice last{cluster_count, 0};
    const int most = most_components(cluster_count);
    while (last.component_count < most &&
           (!bound_.max_error || model.error(last) > *bound_.max_error)) {
      ++last.component_count;
    }
    return work_ + work(last) <= kMostCost * encoding_work(method_, size_, wanted, iterations_);
  }

 private:
  double work(const Choice& last) const {
    const Method method = method_ == Method::fixed ? method_ : Method::iterative;
    return encoding_work(method, {sample_.count, size_.dimension}, last, options_.iterations);
  }

  /// As many as fit the bytes and the sample has points for.
  int most_components(int cluster_count) const {
    int most = bound_.cost.whole(size_).component_count;
    const double points = sample_.points_per_cluster(cluster_count);
    if (sample_.count < sample_.all_count) {
      most = std::min(most, static_cast<int>(points / kPointsPerVector) - 1);
    }
    while (most > 0 && bound_.cost.bytes(size_, {cluster_count, most}) > most_bytes_) --most;
    return std::max(most, 0);
  }

  /// From errors of the sample to those of the signal.
  double correction(std::size_t components) const {
    if (sample_.count == sample_.all_count) return 1.0;
    const auto taken =
        static_cast<double>((components + 1) * static_cast<std::size_t>(options_.cluster_count));
    return std::sqrt((1.0 - taken / static_cast<double>(sample_.all_count)) /
                     (1.0 - taken / static_cast<double>(sample_.count)));
  }

  /// Of what the encoder measured last.
  double relative_error(IterativeEncoder& encoder, double squared_error) const {
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

  Column encode_fixed() {
    const Encoded encoded = encode_static(sample_.signal, dimension_, options_);
    flops_ += encoded.flops;
    const Encoding& encoding = encoded.encoding;
    Column column{encoding.cluster_count,
                  relative_errors(encoding, sample_.signal, bound_.norm, sample_.point_weights)};
    for (std::size_t i = 0; i < column.errors.size(); ++i) column.errors[i] *= correction(i);
    return column;
  }

  Column encode_iteratively() {
    IterativeEncoder encoder(sample_.signal, static_cast<std::size_t>(dimension_), options_);
    Column column{options_.cluster_count, {}};
    for (int i = 0; i <= options_.component_count; ++i) {
      encoder.run_level();
      const double squared_error = encoder.measure();
      column.errors.push_back(relative_error(encoder, squared_error) *
                              correction(static_cast<std::size_t>(i)));
      if (bound_.max_error && column.errors.back() <= *bound_.max_error) break;
    }
    flops_ += encoder.clusterer().flops();
    return column;
  }

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

}  // namespace

int most_clusters(std::size_t point_count) {
  return static_cast<int>(
      std::clamp<std::size_t>(point_count / kSignalPointsPerCluster, 1, kMostClusters));
}

Survey make_survey(const Bound& bound, Method method, std::span<const float> signal, int dimension,
                   const Options& options) {
  const auto n = static_cast<std::size_t>(dimension);
  const Sample sample = make_sample(signal, n, options);
  Surveyor surveyor(bound, method, sample, dimension, options);
  const int most = static_cast<int>(std::max<std::size_t>(1, sample.count / kPointsPerCluster));
  // An eighth of the clusters whose means and vectors take as many bytes as the weights of points:
  // about the fewest that are chosen, as encodings of few clusters take the least time.
  const std::size_t few = sample.all_count * bound.cost.bytes_per_weight / (8 * n * sizeof(float));
  Survey survey;
  survey.sampled_count = sample.count;
  int column_count = 0;
  const auto add = [&](int count) {
    survey.model.add(surveyor.encode(count));
    ++column_count;
  };
  if (dimension <= kMostWhole || most == 1) add(1);
  const int least = std::min(dimension <= kMostWhole ? 2 : 8, most);  // of other columns
  int low = std::clamp(static_cast<int>(std::min<std::size_t>(few, kMostClusters)), least, most);
  if (most > 1) add(low);
  int high = low;
  for (int column = 1; column < kMostColumns && most > 1; ++column) {
    const Choice wanted =
        choose(survey.model, bound, {sample.all_count, n}, most_clusters(sample.all_count));
    const int count = wanted.cluster_count;
    const bool is_more = count > high || (column == 1 && low == least);
    int next = 0;
    if (is_more && high < most && (column == 1 || count > high + high / 3)) {
      next = high = std::min(most, high * kStep);
    } else if (!is_more && low > least && (column == 1 || count < low - low / 4)) {
      next = low = std::max(least, low / kStep);
    }
    // One column alone tells nothing of other numbers of clusters, nor what an encoding takes.
    if (next == 0 || (column_count > 1 && !surveyor.can_afford(survey.model, next, wanted))) break;
    add(next);
  }
  survey.flops = surveyor.flops();
  return survey;
}

}  // namespace prt::cpca
