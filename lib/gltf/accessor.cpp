#include "gltf/accessor.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "core/error.h"

namespace prt::gltf {

namespace {

constexpr std::pair<const char*, std::size_t> kTypes[] = {
    {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};

template <class T>
T load(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof(T));
  return value;
}

// glTF 2.0 §3.11: how normalised integers stand for floats.
template <class T>
float load_normalized(const std::byte* from) {
  const float value =
      static_cast<float>(load<T>(from)) / static_cast<float>(std::numeric_limits<T>::max());
  return std::max(value, -1.0f);
}

float load_float(const std::byte* from, std::size_t component_type, bool normalized) {
  switch (component_type) {
    case kByte:
      return normalized ? load_normalized<std::int8_t>(from) : load<std::int8_t>(from);
    case kUnsignedByte:
      return normalized ? load_normalized<std::uint8_t>(from) : load<std::uint8_t>(from);
    case kShort:
      return normalized ? load_normalized<std::int16_t>(from) : load<std::int16_t>(from);
    case kUnsignedShort:
      return normalized ? load_normalized<std::uint16_t>(from) : load<std::uint16_t>(from);
    case kUnsignedInt:
      return static_cast<float>(load<std::uint32_t>(from));
    default:
      return load<float>(from);
  }
}

std::uint32_t load_unsigned(const std::byte* from, std::size_t component_type) {
  switch (component_type) {
    case kUnsignedByte:
      return load<std::uint8_t>(from);
    case kUnsignedShort:
      return load<std::uint16_t>(from);
    default:
      return load<std::uint32_t>(from);
  }
}

std::size_t component_type_of(const Json& accessor) {
  return accessor.at("componentType").get<std::size_t>();
}

// Copies `count` elements of `size` bytes out of a view.
void copy_elements(const State& state, const Json& source, std::size_t size, std::size_t count,
                   std::byte* to) {
  const std::size_t index = source.at("bufferView").get<std::size_t>();
  const auto bytes = state.view_bytes(index);
  const Json& view = state.element("bufferViews", index);
  const std::size_t stride = view.value("byteStride", size);
  const std::byte* from = bytes.data() + source.value("byteOffset", std::size_t{0});
  for (std::size_t i = 0; i < count; ++i) std::memcpy(to + i * size, from + i * stride, size);
}

void apply_sparse(const State& state, const Json& accessor, std::size_t size, Bytes& elements) {
  const Json& sparse = accessor.at("sparse");
  const std::size_t count = sparse.at("count").get<std::size_t>();
  const Json& index_source = sparse.at("indices");
  const std::size_t type = component_type_of(index_source), width = component_bytes(type);
  Bytes indices(count * width), values(count * size);
  copy_elements(state, index_source, width, count, indices.data());
  copy_elements(state, sparse.at("values"), size, count, values.data());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t target = load_unsigned(&indices[i * width], type);
    if ((target + 1) * size > elements.size()) {
      throw_bad_input("sparse index past the accessor's end",
                      {.file = state.file, .found = std::to_string(target)});
    }
    std::memcpy(&elements[target * size], &values[i * size], size);
  }
}

template <class T>
Bytes to_bytes(std::span<const T> values) {
  const auto bytes = std::as_bytes(values);
  return {bytes.begin(), bytes.end()};
}

}  // namespace

std::size_t component_bytes(std::size_t component_type) {
  switch (component_type) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

std::size_t components_of(const std::string& accessor_type) {
  for (const auto& [name, count] : kTypes) {
    if (accessor_type == name) return count;
  }
  return 0;
}

std::size_t element_bytes(const Json& accessor) {
  const std::string type = accessor.at("type").get<std::string>();
  const std::size_t component = component_bytes(component_type_of(accessor));
  // Columns of matrices start at multiples of 4 bytes.
  if (type == "MAT2" && component == 1) return 8;
  if (type == "MAT3" && component < 4) return component == 1 ? 12 : 24;
  return component * components_of(type);
}

std::size_t accessor_count(const State& state, std::size_t accessor) {
  return state.element("accessors", accessor).at("count").get<std::size_t>();
}

std::size_t accessor_components(const State& state, std::size_t accessor) {
  return components_of(state.element("accessors", accessor).at("type").get<std::string>());
}

Bytes read_elements(const State& state, std::size_t index) {
  const Json& accessor = state.element("accessors", index);
  const std::size_t size = element_bytes(accessor), count = accessor_count(state, index);
  Bytes elements(size * count);
  if (accessor.contains("bufferView")) {
    copy_elements(state, accessor, size, count, elements.data());
  }
  if (accessor.contains("sparse")) apply_sparse(state, accessor, size, elements);
  return elements;
}

std::vector<float> read_floats(const State& state, std::size_t index) {
  const Json& accessor = state.element("accessors", index);
  const std::size_t type = component_type_of(accessor), width = component_bytes(type);
  const bool normalized = accessor.value("normalized", false);
  const Bytes elements = read_elements(state, index);
  std::vector<float> values(elements.size() / width);
  if (type == kFloat) {
    std::memcpy(values.data(), elements.data(), elements.size());
    return values;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = load_float(&elements[i * width], type, normalized);
  }
  return values;
}

std::vector<std::uint32_t> read_unsigned(const State& state, std::size_t index) {
  const std::size_t type = component_type_of(state.element("accessors", index));
  if (type != kUnsignedByte && type != kUnsignedShort && type != kUnsignedInt) {
    throw_bad_input("not unsigned integers", {.file = state.file,
                                              .element = "accessor " + std::to_string(index),
                                              .found = "component type " + std::to_string(type)});
  }
  const std::size_t width = component_bytes(type);
  const Bytes elements = read_elements(state, index);
  std::vector<std::uint32_t> values(elements.size() / width);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = load_unsigned(&elements[i * width], type);
  }
  return values;
}

std::size_t add_view(State& state, Bytes bytes) {
  Json& buffers = make_array(state.root, "buffers");
  Json& views = make_array(state.root, "bufferViews");
  buffers.push_back({{"byteLength", bytes.size()}});
  views.push_back({{"buffer", buffers.size() - 1}, {"byteLength", bytes.size()}});
  state.buffers.push_back(std::move(bytes));
  return views.size() - 1;
}

std::size_t add_accessor(State& state, const NewAccessor& accessor, Bytes bytes) {
  const std::size_t view = add_view(state, std::move(bytes));
  if (accessor.stride > 0) state.root["bufferViews"][view]["byteStride"] = accessor.stride;
  if (accessor.target > 0) state.root["bufferViews"][view]["target"] = accessor.target;
  Json& accessors = make_array(state.root, "accessors");
  accessors.push_back({{"bufferView", view},
                       {"componentType", accessor.component_type},
                       {"count", accessor.count},
                       {"type", accessor.type}});
  return accessors.size() - 1;
}

std::size_t add_floats(State& state, const char* type, std::span<const float> values,
                       std::size_t target) {
  return add_accessor(state,
                      {.component_type = kFloat,
                       .type = type,
                       .count = values.size() / components_of(type),
                       .target = target},
                      to_bytes(values));
}

std::size_t add_indices(State& state, std::span<const std::uint32_t> indices) {
  const std::uint32_t largest =
      indices.empty() ? 0 : *std::max_element(indices.begin(), indices.end());
  NewAccessor accessor{.component_type = kUnsignedInt,
                       .type = "SCALAR",
                       .count = indices.size(),
                       .target = kIndices};
  if (largest >= std::numeric_limits<std::uint16_t>::max()) {
    return add_accessor(state, accessor, to_bytes(indices));
  }
  accessor.component_type = kUnsignedShort;
  const std::vector<std::uint16_t> narrow(indices.begin(), indices.end());
  return add_accessor(state, accessor, to_bytes(std::span<const std::uint16_t>(narrow)));
}

void set_bounds(State& state, std::size_t index) {
  const std::vector<float> values = read_floats(state, index);
  const std::size_t components = accessor_components(state, index);
  std::vector<float> low(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(components));
  std::vector<float> high = low;
  for (std::size_t i = 0; i < values.size(); ++i) {
    low[i % components] = std::min(low[i % components], values[i]);
    high[i % components] = std::max(high[i % components], values[i]);
  }
  // Doubles: a float written with a float's digits may read back as another double than the float.
  Json& accessor = state.root["accessors"][index];
  accessor["min"] = std::vector<double>(low.begin(), low.end());
  accessor["max"] = std::vector<double>(high.begin(), high.end());
}

}  // namespace prt::gltf
