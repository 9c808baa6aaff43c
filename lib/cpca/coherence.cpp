#include "cpca/coherence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "cpca/empty_clusters.h"
#include "cpca/overdraw.h"
#include "cpca/reclassify.h"
#include "cpca/superclusters.h"

namespace prt::cpca {

namespace {

void check(std::span<const float> signal, std::span<const std::uint32_t> indices,
           const CoherenceOptions& options, const Encoding& encoding) {
  if (!std::isfinite(options.error_budget) || options.error_budget < 0.0) {
    throw Error(ErrorKind::usage, "error budget",
                {.found = fmt::format("{}", options.error_budget), .expected = "at least 0"});
  }
  const auto n = static_cast<std::size_t>(encoding.dimension);
  if (signal.size() != encoding.point_count * n) {
    throw_failed("the encoding is of another signal",
                 {.found = fmt::format("{} points", encoding.point_count),
                  .expected = fmt::format("{}", signal.size() / n)});
  }
  const auto largest = std::max_element(indices.begin(), indices.end());
  if (largest != indices.end() && *largest >= encoding.point_count) {
    throw_failed("a triangle of a point that the encoding does not have",
                 {.found = fmt::format("{}", *largest),
                  .expected = fmt::format("less than {}", encoding.point_count)});
  }
}

}  // namespace

Coherence make_coherent(std::span<const float> signal, std::span<const std::uint32_t> indices,
                        int row_count, const CoherenceOptions& options, Encoding& encoding) {
  check(signal, indices, options, encoding);
  Coherence coherence;
  coherence.triangle_count = indices.size() / 3;
  coherence.sent_initial = sent_triangle_count(indices, encoding.cluster_of_point);
  const Reclassification moved =
      reclassify(signal, indices, options.error_budget, encoding, options.limits);
  coherence.moved_count = moved.moved_count;
  coherence.initial_error = moved.initial_error;
  coherence.final_error = moved.final_error;
  drop_empty_clusters(encoding);
  coherence.sent_reclassified = sent_triangle_count(indices, encoding.cluster_of_point);
  coherence.first_clusters = sort_clusters(
      find_superclusters(indices, encoding.cluster_of_point, register_counts(encoding, row_count),
                         options.register_budget),
      encoding);
  coherence.sent_superclustered =
      sent_triangle_count(indices, superclusters_of_points(encoding, coherence.first_clusters));
  return coherence;
}

nlohmann::ordered_json to_json(const Coherence& coherence, const CoherenceOptions& options) {
  const auto rate = [&](std::size_t sent) { return overdraw(sent, coherence.triangle_count); };
  return {{"overdraw_initial", rate(coherence.sent_initial)},
          {"overdraw_reclassified", rate(coherence.sent_reclassified)},
          {"overdraw_superclustered", rate(coherence.sent_superclustered)},
          {"triangle_count", coherence.triangle_count},
          {"sent_triangles_initial", coherence.sent_initial},
          {"sent_triangles_reclassified", coherence.sent_reclassified},
          {"sent_triangles_superclustered", coherence.sent_superclustered},
          {"supercluster_count", coherence.first_clusters.size()},
          {"error_budget", options.error_budget},
          {"register_budget", options.register_budget},
          {"moved_count", coherence.moved_count},
          {"squared_error_initial", coherence.initial_error},
          {"squared_error_reclassified", coherence.final_error}};
}

nlohmann::ordered_json overdraw_to_json(std::span<const std::uint32_t> indices,
                                        const Encoding& encoding) {
  const std::size_t sent = sent_triangle_count(indices, encoding.cluster_of_point);
  return {{"overdraw_initial", overdraw(sent, indices.size() / 3)},
          {"triangle_count", indices.size() / 3},
          {"sent_triangles_initial", sent}};
}

}  // namespace prt::cpca
