#include "compress/summary.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace prt::compress {

namespace {

std::string counted(int count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// "8 components", or of clusters that differ "0 to 13 components, 8.0 a point".
std::string components_text(const nlohmann::ordered_json& json) {
  const int most = json["component_count"].get<int>();
  const int least = json["least_component_count"].get<int>();
  if (least == most) return counted(most, "component");
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
      "{} points of {} coefficients in {} of {}: {:.3g} times smaller, "
      "relative error {:.3f}%{} (SE {:.6g})",
      json["point_count"].get<std::size_t>(), json["dimension"].get<int>(),
      counted(json["cluster_count"].get<int>(), "cluster"), components_text(json),
      json["compression_ratio"].get<double>(), 100.0 * figure("relative_rmse"), greatest,
      figure("squared_error"));
}

}  // namespace prt::compress
