#include "compress/summary.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace prt::compress {

namespace {

/// "8 components", or of clusters that differ "0 to 13 components, 8.0 a point".
std::string components_text(const nlohmann::ordered_json& json) {
  const int most = json["component_count"].get<int>();
  const int least = json["least_component_count"].get<int>();
  if (least == most) return fmt::format("{} components", most);
  return fmt::format("{} to {} components, {:.1f} a point", least, most,
                     json["mean_component_count"].get<double>());
}

}  // namespace

std::string summary(const nlohmann::ordered_json& json, cpca::Norm norm) {
  const auto figure = [&](const std::string& name) {
    return json.value("weighted_" + name, json[name].get<double>());
  };
  const std::string greatest =
      norm == cpca::Norm::rmse
          ? ""
          : fmt::format(", of a point at most {:.3f}%", 100.0 * figure("relative_max"));
  return fmt::format(
      "{} points of {} coefficients in {} clusters of {}: {:.3g} times smaller, "
      "relative error {:.3f}%{} (SE {:.6g})",
      json["point_count"].get<std::size_t>(), json["dimension"].get<int>(),
      json["cluster_count"].get<int>(), components_text(json),
      json["compression_ratio"].get<double>(), 100.0 * figure("relative_rmse"), greatest,
      figure("squared_error"));
}

}  // namespace prt::compress
