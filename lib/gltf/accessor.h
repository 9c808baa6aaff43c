// Accessors: typed arrays over buffer views, with strides, normalised integers and sparse changes.
// Their ranges were checked when the document was loaded (gltf/check.h) or made by us.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gltf/state.h"

namespace prt::gltf {

/// glTF's component types.
constexpr std::size_t kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                      kUnsignedInt = 5125, kFloat = 5126;

std::size_t component_bytes(std::size_t component_type);      ///< 0: unknown
std::size_t components_of(const std::string& accessor_type);  ///< 0: unknown
std::size_t element_bytes(const Json& accessor);              ///< of a checked accessor

std::size_t accessor_count(const State& state, std::size_t accessor);
std::size_t accessor_components(const State& state, std::size_t accessor);

/// All elements, tightly packed, sparse changes applied, as they are stored.
Bytes read_elements(const State& state, std::size_t accessor);
/// The same as floats; integers are scaled when the accessor is normalised.
std::vector<float> read_floats(const State& state, std::size_t accessor);
/// Unsigned integers of any width.
std::vector<std::uint32_t> read_unsigned(const State& state, std::size_t accessor);

/// What a new accessor holds.
struct NewAccessor {
  std::size_t component_type;
  const char* type;
  std::size_t count;
  std::size_t stride = 0;  ///< of the buffer view; 0: tight
  std::size_t target = 0;  ///< of the buffer view: kVertices, kIndices or none
};
constexpr std::size_t kVertices = 34962, kIndices = 34963;

/// Appends a buffer, a buffer view and an accessor. Returns the accessor's number.
std::size_t add_accessor(State& state, const NewAccessor& accessor, Bytes bytes);
/// The same for floats: `values` holds count × components.
std::size_t add_floats(State& state, const char* type, std::span<const float> values,
                       std::size_t target);
std::size_t add_indices(State& state, std::span<const std::uint32_t> indices);
/// A buffer and a view of it, for images.
std::size_t add_view(State& state, Bytes bytes);
/// Sets min and max, which glTF demands of positions.
void set_bounds(State& state, std::size_t accessor);

}  // namespace prt::gltf
