// Figures that describe many values, and vectors, as JSON.
#pragma once

#include <span>
#include <vector>

#include "core/vec.h"
#include "inspect/inspection.h"

namespace prt::inspect {

/// [x, y, z]
inline Json to_json(const Vec3& v) { return {v.x, v.y, v.z}; }

/// {"min", "max", "mean"} of finite values; empty object when there are none.
Json range_of(std::span<const float> values);

/// {"p50", "p90", "p99", "max"}, nearest rank; empty object when there are none.
Json percentiles_of(std::vector<double> values);

/// The value below or at which `share` (0 to 1) of the values lie, nearest rank. Not empty.
double percentile(std::vector<double>& values, double share);

/// How many are not finite.
std::size_t count_non_finite(std::span<const float> values);

}  // namespace prt::inspect
