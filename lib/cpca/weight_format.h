// How weights are stored. Normalised integers take the least; where a weight lies between the least
// and the greatest of its cluster and component is all they say, and the cluster's mean and basis
// vectors hold the scale and the offset. Half floats take as much room as integers of 16 bits and
// are the finer of the two where few weights are much greater than the others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cpca/encoding.h"
#include "cpca/error_limits.h"

namespace prt::cpca {

/// Share of the squared error that smaller weights may add where choose_weights decides.
constexpr double kMaxAddedError = 0.01;

enum class WeightFormat { float32, float16, unorm16, unorm8 };

/// The greatest finite half float; what rounds to more is beyond the format.
constexpr float kGreatestHalf = 65504.0f;

/// float, half, unorm16, unorm8.
const char* name_of(WeightFormat format);
std::size_t bytes_of(WeightFormat format);
bool is_normalized(WeightFormat format);
/// The greatest integer of a normalised format, which stands for 1.
float greatest(WeightFormat format);

/// Makes weights numbers of the format, rounded to the nearest.
/// Normalised, they become multiples of 1 / greatest(format) in [0, 1]: for every cluster and
/// component, with l and g the least and the greatest weight, x_0 becomes x_0 + l x_i and x_i
/// becomes (g - l) x_i, which are orthogonal but no longer of length 1. Half floats are rounded
/// (ties to even) and no more. Nothing happens for float32.
/// Throws Error (failed) when a weight is beyond the greatest half float.
void convert_weights(WeightFormat format, Encoding& encoding);

/// The numbers of a format, as convert_weights makes them, as files and OpenGL's buffers hold them:
/// floats, binary16 of IEEE 754, integers; little endian.
std::vector<std::byte> stored_weights(WeightFormat format, std::span<const float> weights);
/// The number that the bits of a half float stand for; may be infinite or no number.
float weight_from_half(std::uint16_t bits);

/// Stores weights in the given format or, without one, in the smallest that makes the squared error
/// at most 1% greater and keeps to the limits; of two as small, in the one with less error. Returns
/// the format. `signal` is what the encoding encodes; errors count by the weights of the limits.
/// Throws as convert_weights.
WeightFormat choose_weights(std::span<const float> signal, std::optional<WeightFormat> format,
                            Encoding& encoding, const ErrorLimits& limits = {});

}  // namespace prt::cpca
