#include "cpca/report.h"

#include <nlohmann/json.hpp>
#include <vector>

namespace prt::cpca {

namespace {

nlohmann::ordered_json figures_to_json(const Figures& figures) {
  return {{"squared_error", figures.squared_error},
          {"signal_energy", figures.signal_energy},
          {"relative_rmse", figures.relative_rmse()},
          {"max_point_error", figures.max_point_error}};
}

nlohmann::ordered_json levels_to_json(std::span<const Level> levels) {
  auto json = nlohmann::ordered_json::array();
  for (const Level& level : levels) {
    json.push_back({{"component_count", level.component_count}, {"errors", level.errors}});
  }
  return json;
}

nlohmann::ordered_json groups_to_json(std::span<const Group> groups, std::span<const double> errors,
                                      std::span<const float> signal) {
  auto json = nlohmann::ordered_json::array();
  const std::size_t dimension = signal.size() / errors.size();
  std::size_t first = 0;
  for (const Group& group : groups) {
    nlohmann::ordered_json entry{{"name", group.name}, {"vertex_count", group.point_count}};
    entry.update(figures_to_json(
        summarize(errors.subspan(first, group.point_count),
                  signal.subspan(first * dimension, group.point_count * dimension))));
    json.push_back(std::move(entry));
    first += group.point_count;
  }
  return json;
}

}  // namespace

nlohmann::ordered_json to_json(const Encoded& encoded, std::span<const float> signal,
                               std::span<const Group> groups) {
  const Encoding& encoding = encoded.encoding;
  const std::size_t signal_bytes = signal.size_bytes(), bytes = storage_bytes(encoding);
  const std::vector<double> errors = point_errors(encoding, signal);
  nlohmann::ordered_json json{
      {"point_count", encoding.point_count},
      {"dimension", encoding.dimension},
      {"cluster_count", encoding.cluster_count},
      {"component_count", encoding.component_count},
      {"iteration_count", encoded.iterations},
      {"resumed_iteration_count", encoded.resumed_iterations},
      {"iterations", levels_to_json(encoded.levels)},
      {"signal_bytes", signal_bytes},
      {"bytes", bytes},
      {"compression_ratio", static_cast<double>(signal_bytes) / static_cast<double>(bytes)}};
  double seconds = 0.0;
  for (const Stage& stage : encoded.stages) seconds += stage.seconds;
  json["gflops"] = seconds > 0.0 ? 1e-9 * encoded.flops / seconds : 0.0;
  json.update(figures_to_json(summarize(errors, signal)));
  if (!groups.empty()) json["meshes"] = groups_to_json(groups, errors, signal);
  return json;
}

}  // namespace prt::cpca
