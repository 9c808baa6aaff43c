// How weights are stored. Normalised integers take the least; where a weight lies between the least
// and the greatest of its cluster and component is all they say, and the cluster's mean and basis
// vectors hold the scale and the offset.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cpca/encoding.h"
#include "cpca/error_limits.h"

namespace prt::cpca {

/// Share of the squared error that integers may add where choose_weights decides.
constexpr double kMaxAddedError = 0.01;

enum class WeightFormat { float32, unorm16, unorm8 };

/// float, unorm16, unorm8.
const char* name_of(WeightFormat format);
std::size_t bytes_of(WeightFormat format);
/// The greatest integer of a normalised format, which stands for 1.
float greatest(WeightFormat format);

/// Makes weights whole multiples of 1 / greatest(format) in [0, 1], rounded to the nearest: for
/// every cluster and component, with l and g the least and the greatest weight, x_0 becomes
/// x_0 + l x_i and x_i becomes (g - l) x_i, which are orthogonal but no longer of length 1. Nothing
/// happens for float32.
void normalize_weights(WeightFormat format, Encoding& encoding);

/// Stores weights in the given format or, without one, in the smallest that makes the squared error
/// at most 1% greater and keeps to the limits. Returns the format. `signal` is what the encoding
/// encodes; errors count by the weights of the limits.
WeightFormat choose_weights(std::span<const float> signal, std::optional<WeightFormat> format,
                            Encoding& encoding, const ErrorLimits& limits = {});

}  // namespace prt::cpca
