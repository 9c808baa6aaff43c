// What the user is told of a compression, in one line.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cpca/search_choice.h"

namespace prt::compress {

/// Of a report (docs/tools/prt-compress.md), by the errors that counted. Under the maximum norm
/// with the greatest error of a point.
std::string summary(const nlohmann::ordered_json& json, cpca::Norm norm);

}  // namespace prt::compress
