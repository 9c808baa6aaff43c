#include "gltf/accessor.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

#include "core/error.h"

namespace prt::gltf {

namespace {

constexpr std::pair<const char*, int> kTypes[] = {
    {"SCALAR", TINYGLTF_TYPE_SCALAR}, {"VEC2", TINYGLTF_TYPE_VEC2}, {"VEC3", TINYGLTF_TYPE_VEC3},
    {"VEC4", TINYGLTF_TYPE_VEC4},     {"MAT2", TINYGLTF_TYPE_MAT2}, {"MAT3", TINYGLTF_TYPE_MAT3},
    {"MAT4", TINYGLTF_TYPE_MAT4}};

template <class T>
T load(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof(T));
  return value;
}

// Calls `function` with a zero of the type that glTF's number stands for.
template <class Function>
auto with_type(int component_type, const Function& function) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return function(std::int8_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return function(std::uint8_t{});
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return function(std::int16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return function(std::uint16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return function(std::uint32_t{});
    default:
      return function(float{});
  }
}

// The elements' components, one after the other, as another type.
template <class To>
std::vector<To> convert(const Bytes& elements, int component_type) {
  return with_type(component_type, [&](auto zero) {
    using From = decltype(zero);
    std::vector<To> values(elements.size() / sizeof(From));
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = static_cast<To>(load<From>(&elements[i * sizeof(From)]));
    }
    return values;
  });
}

// Copies `count` elements of `size` bytes out of a view.
void copy_elements(const Model& model, int view, std::size_t offset, std::size_t size,
                   std::size_t count, std::byte* to) {
  const std::size_t view_stride = model.bufferViews[static_cast<std::size_t>(view)].byteStride;
  const std::size_t stride = view_stride > 0 ? view_stride : size;
  const std::byte* from = model.view_bytes(view).data() + offset;
  for (std::size_t i = 0; i < count; ++i) std::memcpy(to + i * size, from + i * stride, size);
}

void apply_sparse(const Model& model, const tinygltf::Accessor& accessor, std::size_t size,
                  Bytes& elements) {
  const auto& indices = accessor.sparse.indices;
  const auto& values = accessor.sparse.values;
  const auto count = static_cast<std::size_t>(accessor.sparse.count);
  const std::size_t width = component_bytes(static_cast<std::size_t>(indices.componentType));
  Bytes target_bytes(count * width), changed(count * size);
  copy_elements(model, indices.bufferView, static_cast<std::size_t>(indices.byteOffset), width,
                count, target_bytes.data());
  copy_elements(model, values.bufferView, static_cast<std::size_t>(values.byteOffset), size, count,
                changed.data());
  const auto targets = convert<std::uint32_t>(target_bytes, indices.componentType);
  for (std::size_t i = 0; i < count; ++i) {
    if (targets[i] >= accessor.count) {
      throw_bad_input("sparse index past the accessor's end",
                      {.file = model.state.file, .found = std::to_string(targets[i])});
    }
    std::memcpy(&elements[targets[i] * size], &changed[i * size], size);
  }
}

template <class T>
Bytes to_bytes(std::span<const T> values) {
  const auto bytes = std::as_bytes(values);
  return {bytes.begin(), bytes.end()};
}

}  // namespace

std::size_t component_bytes(std::size_t component_type) {
  // tinygltf also knows integers and doubles, which glTF does not.
  if (component_type > TINYGLTF_COMPONENT_TYPE_FLOAT ||
      component_type == TINYGLTF_COMPONENT_TYPE_INT) {
    return 0;
  }
  const int bytes = tinygltf::GetComponentSizeInBytes(static_cast<unsigned>(component_type));
  return static_cast<std::size_t>(std::max(bytes, 0));
}

int type_code(const std::string& type) {
  for (const auto& [name, code] : kTypes) {
    if (type == name) return code;
  }
  return -1;
}

std::size_t component_count(int type) {
  return static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<unsigned>(type)));
}

std::size_t element_bytes(int component_type, int type) {
  const std::size_t component = component_bytes(static_cast<std::size_t>(component_type));
  // Columns of matrices start at multiples of 4 bytes.
  if (type == TINYGLTF_TYPE_MAT2 && component == 1) return 8;
  if (type == TINYGLTF_TYPE_MAT3 && component < 4) return component == 1 ? 12 : 24;
  return component * component_count(type);
}

const tinygltf::Accessor& accessor_of(const Model& model, int accessor) {
  return model.accessors.at(static_cast<std::size_t>(accessor));
}

std::size_t component_count(const tinygltf::Accessor& accessor) {
  return component_count(accessor.type);
}

Bytes read_elements(const Model& model, int index) {
  const tinygltf::Accessor& accessor = accessor_of(model, index);
  const std::size_t size = element_bytes(accessor.componentType, accessor.type);
  Bytes elements(size * accessor.count);
  if (accessor.bufferView >= 0) {
    copy_elements(model, accessor.bufferView, accessor.byteOffset, size, accessor.count,
                  elements.data());
  }
  if (accessor.sparse.isSparse) apply_sparse(model, accessor, size, elements);
  return elements;
}

std::vector<float> read_components(const Model& model, int index) {
  return convert<float>(read_elements(model, index), accessor_of(model, index).componentType);
}

std::vector<float> read_floats(const Model& model, int index) {
  std::vector<float> values = read_components(model, index);
  const tinygltf::Accessor& accessor = accessor_of(model, index);
  if (!accessor.normalized) return values;
  // glTF 2.0 §3.11; only integers of 8 and 16 bits may be normalised.
  const float one = with_type(accessor.componentType, [](auto zero) {
    return sizeof(zero) < 4 ? static_cast<float>(std::numeric_limits<decltype(zero)>::max()) : 1.0f;
  });
  if (one == 1.0f) return values;
  for (float& value : values) value = std::max(value / one, -1.0f);
  return values;
}

std::vector<std::uint32_t> read_unsigned(const Model& model, int index) {
  const int type = accessor_of(model, index).componentType;
  const bool is_unsigned =
      with_type(type, [](auto zero) { return std::is_unsigned_v<decltype(zero)>; });
  if (!is_unsigned) {
    throw_bad_input("not unsigned integers", {.file = model.state.file,
                                              .element = "accessor " + std::to_string(index),
                                              .found = "component type " + std::to_string(type)});
  }
  return convert<std::uint32_t>(read_elements(model, index), type);
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
  if (accessor.normalized) accessors.back()["normalized"] = true;
  return accessors.size() - 1;
}

std::size_t add_floats(State& state, const char* type, std::span<const float> values, int target) {
  return add_accessor(state,
                      {.component_type = TINYGLTF_COMPONENT_TYPE_FLOAT,
                       .type = type,
                       .count = values.size() / component_count(type_code(type)),
                       .target = target},
                      to_bytes(values));
}

std::size_t add_indices(State& state, std::span<const std::uint32_t> indices) {
  const std::uint32_t largest =
      indices.empty() ? 0 : *std::max_element(indices.begin(), indices.end());
  NewAccessor accessor{.component_type = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                       .type = "SCALAR",
                       .count = indices.size(),
                       .target = TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER};
  if (largest >= std::numeric_limits<std::uint16_t>::max()) {
    return add_accessor(state, accessor, to_bytes(indices));
  }
  accessor.component_type = TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
  const std::vector<std::uint16_t> narrow(indices.begin(), indices.end());
  return add_accessor(state, accessor, to_bytes(std::span<const std::uint16_t>(narrow)));
}

void set_bounds(State& state, std::size_t index, std::span<const float> components) {
  Json& accessor = state.root["accessors"][index];
  const std::size_t n = component_count(type_code(accessor["type"].get<std::string>()));
  std::vector<float> low(components.begin(), components.begin() + static_cast<std::ptrdiff_t>(n));
  std::vector<float> high = low;
  for (std::size_t i = 0; i < components.size(); ++i) {
    low[i % n] = std::min(low[i % n], components[i]);
    high[i % n] = std::max(high[i % n], components[i]);
  }
  // Doubles: a float written with a float's digits may read back as another double than the float.
  accessor["min"] = std::vector<double>(low.begin(), low.end());
  accessor["max"] = std::vector<double>(high.begin(), high.end());
}

}  // namespace prt::gltf
