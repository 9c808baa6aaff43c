#include "cpca/search_survey.h"

#include <algorithm>
#include <optional>

#include "cpca/search_sample.h"
#include "cpca/surveyor.h"

namespace prt::cpca {

namespace {

constexpr int kStep = 4, kMostColumns = 4;
/// Points of a cluster of the sample, at least.
constexpr std::size_t kPointsPerCluster = 6;
constexpr std::size_t kMostClusters = 65536, kSignalPointsPerCluster = 2;

/// One cluster with as few vectors as are enough.
std::optional<Choice> one_within(const ErrorModel& model, Bound bound, const Size& size) {
  bound.max_error = bound.max_error.value_or(kExact);
  for (int i = 0; i <= model.most_components(); ++i) {
    if (const auto one = choose_clusters(model, bound, size, 1, i)) return one;
  }
  return std::nullopt;
}

/// Of more clusters than one.
void add_columns(const Bound& bound, const Size& size, Surveyor& surveyor, Survey& survey) {
  const int most = survey.equal_rows ? survey.equal_rows->count() - 1
                                     : static_cast<int>(survey.sampled_count / kPointsPerCluster);
  if (most < 2) return;
  // An eighth of the clusters whose means and vectors take as many bytes as the weights of points:
  // about the fewest that are chosen, as encodings of few clusters take the least time.
  const std::size_t few =
      size.point_count * bound.cost.bytes_per_weight / (8 * size.dimension * sizeof(float));
  const int least = std::min(size.dimension <= kMostWhole ? 2 : 8, most);
  int low = std::clamp(static_cast<int>(std::min<std::size_t>(few, kMostClusters)), least, most);
  // Where one cluster takes little, others have to promise something before they are looked at.
  const std::optional<Choice> one = one_within(survey.model, bound, size);
  if (one && !surveyor.can_afford(survey.model, low, *one) &&
      !surveyor.may_take_less(survey.model, low, *one)) {
    return;
  }
  survey.model.add(surveyor.encode(low));
  int high = low;
  for (int column = 1; column < kMostColumns; ++column) {
    const Choice wanted = choose(survey.model, bound, size, most_clusters(size.point_count));
    const int count = wanted.cluster_count;
    const bool is_more = count > high || (column == 1 && low == least);
    int next = 0;
    // As clusters become as many as rows, errors fall faster than anything before tells.
    const int near = survey.equal_rows ? high : high + high / 3;
    if (is_more && high < most && (column == 1 || count > near)) {
      next = high = std::min(most, high * kStep);
    } else if (!is_more && low > least && (column == 1 || count < low - low / 4)) {
      next = low = std::max(least, low / kStep);
    }
    // Of many coefficients one cluster tells little of others, nor do these alone.
    const bool is_due = column == 1 && size.dimension > kMostWhole && count > 1;
    if (next == 0 || !(is_due || surveyor.can_afford(survey.model, next, wanted))) break;
    survey.model.add(surveyor.encode(next));
  }
}

}  // namespace

int most_clusters(std::size_t point_count) {
  return static_cast<int>(
      std::clamp<std::size_t>(point_count / kSignalPointsPerCluster, 1, kMostClusters));
}

Survey make_survey(const Bound& bound, Method method, std::span<const float> signal, int dimension,
                   const Options& options) {
  const auto n = static_cast<std::size_t>(dimension);
  const Size size{signal.size() / n, n};
  Survey survey;
  survey.sampled_count = sample_count(size.point_count);
  const auto most_rows =
      std::min(survey.sampled_count - 1, static_cast<std::size_t>(most_clusters(size.point_count)));
  // How many points are like a row is no part of the largest error of one.
  if (bound.norm == Norm::rmse) survey.equal_rows = find_equal_rows(signal, n, most_rows);
  if (survey.equal_rows) survey.sampled_count = size.point_count;
  const Sample sample = survey.equal_rows ? make_sample(signal, n, options, *survey.equal_rows)
                                          : make_sample(signal, n, options);
  Surveyor surveyor(bound, method, sample, dimension, options);
  // Nothing is smaller.
  const Column mean = surveyor.encode_one_of_all(0, signal, options.point_weights);
  const bool is_enough = surveyor.is_enough(mean.errors[0]);
  const bool has_vectors = bound.cost.whole(size).component_count > 0;
  survey.model.add(is_enough || !has_vectors ? mean : surveyor.encode_one());
  const std::optional<Choice> one = one_within(survey.model, bound, size);
  if (one && surveyor.can_afford_all(*one)) {
    const int most = std::min(2 * one->component_count, bound.cost.whole(size).component_count);
    survey.model.add(surveyor.encode_one_of_all(most, signal, options.point_weights));
  }
  if (!is_enough) add_columns(bound, size, surveyor, survey);
  survey.flops = surveyor.flops();
  return survey;
}

}  // namespace prt::cpca
