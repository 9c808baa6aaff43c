#include "inspect/encoding_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "cpca/coherence.h"
#include "cpca/encoder.h"
#include "cpca/iterative_encoder.h"
#include "cpca/reclassify.h"
#include "cpca/superclusters.h"

namespace prt::inspect {

namespace {

constexpr int kVectorCounts[] = {0, 1, 2, 4, 8, 16};
constexpr int kMostClusters = 1024;

/// Squared error with the first 0, 1, … component_count vectors of each cluster: vectors of static
/// CPCA are nested and orthonormal, so that leaving one out adds its weights' squares.
std::vector<double> errors_by_count(const cpca::Encoding& encoding,
                                    const std::vector<float>& signal) {
  const auto components = static_cast<std::size_t>(encoding.component_count);
  const std::vector<double> errors = cpca::point_errors(encoding, signal);
  std::vector<double> by_count(components + 1);
  by_count[components] = std::accumulate(errors.begin(), errors.end(), 0.0);
  for (std::size_t i = components; i > 0; --i) {
    double squares = 0.0;
    for (std::size_t w = i - 1; w < encoding.weights.size(); w += components) {
      squares += double{encoding.weights[w]} * double{encoding.weights[w]};
    }
    by_count[i - 1] = by_count[i] + squares;
  }
  return by_count;
}

/// An adaptive encoding from the clusters of an iterative one, which it would begin with anyway.
cpca::Encoding adapt(const signal::TransferSignal& signal, int component_count, int cluster_count,
                     const std::vector<std::uint32_t>& labels, double squared_error) {
  return cpca::encode_adaptive(signal.values, signal.dimension(),
                               {.cluster_count = cluster_count,
                                .component_count = component_count,
                                .start = {.labels = labels, .squared_error = squared_error}})
      .encoding;
}

/// Of static encodings, which are 1, 4, 16 … up to these.
int most_static_clusters(std::size_t point_count) {
  int most = 1;
  while (4 * most <= std::min(static_cast<int>(point_count) / 32, kMostClusters)) most *= 4;
  return most;
}

bool has_adaptive(int component_count, int most) {
  return component_count == most || std::ranges::count(kVectorCounts, component_count) > 0;
}

std::vector<double> counts_up_to(int most) {
  std::vector<double> counts(static_cast<std::size_t>(most) + 1);
  std::iota(counts.begin(), counts.end(), 0.0);
  return counts;
}

}  // namespace

LinePlot error_over_storage(const signal::TransferSignal& signal) {
  const auto point_count = static_cast<int>(signal.vertex_count());
  const int most = most_static_clusters(signal.vertex_count());
  LinePlot plot{
      .title = fmt::format(
          "Squared error over storage, static CPCA of 1, 4, 16 ... clusters up to {}", most),
      .x_label = "numbers stored",
      .y_label = "squared error",
      .log_x = true,
      .series = {}};
  const int dimension = signal.dimension();
  for (const int n : kVectorCounts) {
    if (n <= dimension) plot.series.push_back({fmt::format("n' = {}", n), {}, {}});
  }
  for (int clusters = 1; clusters <= most; clusters *= 4) {
    const cpca::Encoded encoded = cpca::encode_static(
        signal.values, dimension,
        {.cluster_count = clusters, .component_count = std::min(dimension, kVectorCounts[5])});
    const std::vector<double> errors = errors_by_count(encoded.encoding, signal.values);
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
      const int n = kVectorCounts[i];
      plot.series[i].x.push_back(double{1.0} * point_count * n +
                                 double{1.0} * clusters * (n + 1) * dimension);
      plot.series[i].y.push_back(errors[static_cast<std::size_t>(n)]);
    }
  }
  return plot;
}

LinePlot error_over_components(const signal::TransferSignal& signal, int cluster_count,
                               int most_components) {
  const int most = std::min(most_components, signal.dimension());
  const cpca::Options options{.cluster_count = cluster_count, .component_count = most};
  LinePlot plot{.title = fmt::format("Squared error over vectors, {} clusters", cluster_count),
                .x_label = "vectors a cluster",
                .y_label = "squared error",
                .series = {}};
  const cpca::Encoded fixed = cpca::encode_static(signal.values, signal.dimension(), options);
  plot.series.push_back(
      {"static", counts_up_to(most), errors_by_count(fixed.encoding, signal.values)});
  cpca::IterativeEncoder iterative(signal.values, static_cast<std::size_t>(signal.dimension()),
                                   options);
  Series curve{"iterative", {}, {}}, adaptive{"adaptive", {}, {}};
  for (int n = 0; n <= most; ++n) {
    iterative.run_level();
    const double error = iterative.measure();
    curve.x.push_back(n);
    curve.y.push_back(error);
    if (!has_adaptive(n, most)) continue;
    const auto errors = cpca::point_errors(
        adapt(signal, n, cluster_count, iterative.clusterer().labels(), error), signal.values);
    adaptive.x.push_back(n);
    adaptive.y.push_back(std::accumulate(errors.begin(), errors.end(), 0.0));
  }
  plot.series.push_back(std::move(curve));
  plot.series.push_back(std::move(adaptive));
  return plot;
}

// As measured of a bunny of 34,835 vertices, 75 coefficients and 256 clusters: a level of n vectors
// takes 3 + n, 0.1 s on two cores, an adaptive encoding from there 8 + 6 n, and a static
// encoding 4.
StudyWork study_work(std::size_t point_count, int cluster_count, int component_count,
                     int most_components) {
  const auto levels = [](int n) { return 3.0 * (n + 1) + 0.5 * n * (n + 1); };
  const auto adaptive = [](int n) { return 8.0 + 6.0 * n; };
  constexpr double kStatic = 4.0;
  StudyWork work{.iterative = levels(component_count),
                 .methods = kStatic + adaptive(component_count),
                 .components = kStatic + levels(most_components)};
  for (int k = 1; k <= most_static_clusters(point_count); k *= 4) {
    work.storage += kStatic * k / cluster_count;
  }
  for (int n = 0; n <= most_components; ++n) {
    if (has_adaptive(n, most_components)) work.components += adaptive(n);
  }
  return work;
}

cpca::Encoding encode_iteratively(const signal::TransferSignal& signal, int cluster_count,
                                  int component_count) {
  return cpca::encode_iterative(
             signal.values, signal.dimension(),
             {.cluster_count = cluster_count, .component_count = component_count})
      .encoding;
}

EncodingError error_of(const std::string& name, const cpca::Encoding& encoding,
                       const signal::TransferSignal& signal) {
  std::vector<double> errors = cpca::point_errors(encoding, signal.values);
  const double energy =
      std::transform_reduce(signal.values.begin(), signal.values.end(), 0.0, std::plus<>(),
                            [](float value) { return double{value} * double{value}; });
  EncodingError result{name, std::accumulate(errors.begin(), errors.end(), 0.0), {}};
  for (double& error : errors) {
    error = energy > 0.0 ? std::sqrt(error * static_cast<double>(errors.size()) / energy) : 0.0;
  }
  result.relative = std::move(errors);
  return result;
}

std::vector<EncodingError> errors_by_method(const signal::TransferSignal& signal,
                                            const cpca::Encoding& iterative) {
  const cpca::Options options{.cluster_count = iterative.cluster_count,
                              .component_count = iterative.component_count};
  const cpca::Encoded fixed = cpca::encode_static(signal.values, signal.dimension(), options);
  const EncodingError error = error_of("iterative", iterative, signal);
  const cpca::Encoding adaptive = adapt(signal, iterative.component_count, iterative.cluster_count,
                                        iterative.cluster_of_point, error.squared_error);
  return {error_of("static", fixed.encoding, signal), error,
          error_of("adaptive", adaptive, signal)};
}

CoherenceStudy study_coherence(const signal::TransferSignal& signal,
                               const std::vector<std::uint32_t>& indices, cpca::Encoding encoding) {
  CoherenceStudy study;
  study.before = encoding.cluster_of_point;
  cpca::Encoding reclassified = encoding;  // with clusters numbered as they are
  cpca::reclassify(signal.values, indices, cpca::CoherenceOptions{}.error_budget, reclassified);
  study.reclassified = std::move(reclassified.cluster_of_point);
  const cpca::Coherence coherence =
      cpca::make_coherent(signal.values, indices, signal.row_count, {}, encoding);
  study.superclustered = cpca::superclusters_of_points(encoding, coherence.first_clusters);
  return study;
}

}  // namespace prt::inspect
