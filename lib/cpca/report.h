// What a run report says about an encoding (docs/tools/prt-compress.md lists the keys).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "cpca/encoder.h"
#include "cpca/figures.h"

namespace prt::cpca {

/// Some consecutive points that are reported together: those of one mesh primitive.
struct Group {
  std::string name;
  std::size_t point_count;
};

/// Error figures, sizes, and what the encoder did. `signal` is what was encoded; the groups hold
/// all of its points, or there are none.
nlohmann::ordered_json to_json(const Encoded& encoded, std::span<const float> signal,
                               std::span<const Group> groups);

}  // namespace prt::cpca
