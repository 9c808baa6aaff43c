// Accessors: typed arrays over buffer views, with strides, normalised integers and sparse changes.
// Their ranges were checked when the document was loaded (gltf/check.h) or made by us.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gltf/model.h"

namespace prt::gltf {

std::size_t component_bytes(std::size_t component_type);  ///< 0: not one of glTF's
int type_code(const std::string& type);                   ///< tinygltf's of "VEC3"; -1: unknown
std::size_t element_bytes(int component_type, int type);  ///< of known ones

const tinygltf::Accessor& accessor_of(const Model& model, int accessor);
std::size_t component_count(const tinygltf::Accessor& accessor);  ///< of an element
std::size_t component_count(int type);                            ///< of an element of that type

/// All elements, tightly packed, sparse changes applied, as they are stored.
Bytes read_elements(const Model& model, int accessor);
/// The same as floats.
std::vector<float> read_components(const Model& model, int accessor);
/// The same, scaled where the accessor is normalised.
std::vector<float> read_floats(const Model& model, int accessor);
/// Unsigned integers of any width.
std::vector<std::uint32_t> read_unsigned(const Model& model, int accessor);

/// What a new accessor holds.
struct NewAccessor {
  int component_type;
  const char* type;
  std::size_t count;
  std::size_t stride = 0;  ///< of the buffer view; 0: tight
  int target = 0;          ///< of the buffer view; 0: none
  bool normalized = false;
};

/// Appends a buffer, a buffer view and an accessor. Returns the accessor's number.
std::size_t add_accessor(State& state, const NewAccessor& accessor, Bytes bytes);
/// The same for floats: `values` holds count × components.
std::size_t add_floats(State& state, const char* type, std::span<const float> values, int target);
std::size_t add_indices(State& state, std::span<const std::uint32_t> indices);
/// A buffer and a view of it, for images.
std::size_t add_view(State& state, Bytes bytes);
/// Sets min and max, which glTF demands of positions, to those of the accessor's components.
void set_bounds(State& state, std::size_t accessor, std::span<const float> components);

}  // namespace prt::gltf
