#include "gltf/check.h"

#include <fmt/format.h>

#include <algorithm>

#include "gltf/accessor.h"

namespace prt::gltf {

namespace {

// An accessor without a view is all zeros: nothing in the file bounds its count.
constexpr std::size_t kMaxZeroCount = std::size_t{1} << 22;
constexpr std::size_t kMaxZeroBytes = std::size_t{1} << 28;  // of all of them

constexpr std::size_t kMaxTexcoordSets = 1 << 16;

constexpr const char* kArrays[] = {"accessors", "animations", "buffers", "bufferViews", "cameras",
                                   "images",    "materials",  "meshes",  "nodes",       "samplers",
                                   "scenes",    "skins",      "textures"};

constexpr const char* kSupportedRequired[] = {"KHR_mesh_quantization", "KHR_texture_transform",
                                              "KHR_lights_punctual", "KHR_animation_pointer"};

void check_arrays(const State& state) {
  for (const char* name : kArrays) {
    const Json* array = find(state.root, name);
    if (!array) continue;
    if (!array->is_array()) reject_at({state.file, name}, "not an array", array->type_name());
    for (std::size_t i = 0; i < array->size(); ++i) {
      if (!(*array)[i].is_object()) reject_at({state.file, name}, "not an object");
    }
  }
  const Where asset{state.file, "asset"};
  const Json* version = find(state.root, "asset");
  if (!version || !optional_string(*version, "version", asset).starts_with("2.")) {
    reject_at(asset, "not glTF 2.0");
  }
}

void check_required_extensions(const State& state) {
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    const Json& names = array_of(state.root, list);
    const Where where{state.file, list};
    if (!names.is_array()) reject_at(where, "not an array");
    for (const Json& name : names) {
      if (!name.is_string()) reject_at(where, "not a string");
    }
  }
  for (const Json& json : array_of(state.root, "extensionsRequired")) {
    const auto name = json.get<std::string>();
    const bool known =
        (name.starts_with("KHR_materials_") && name != "KHR_materials_pbrSpecularGlossiness") ||
        std::find(std::begin(kSupportedRequired), std::end(kSupportedRequired), name) !=
            std::end(kSupportedRequired);
    if (!known) {
      reject_at({state.file, "extensionsRequired"}, "unsupported extension", name, {},
                "Export the file without it, or uncompressed.");
    }
  }
}

void check_views(const State& state) {
  const Json& views = array_of(state.root, "bufferViews");
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Where where = state.where("bufferView", i);
    const std::size_t buffer = required_index(views[i], "buffer", state.buffers.size(), where);
    const std::size_t offset = optional_count(views[i], "byteOffset", 0, where);
    const std::size_t length = required_count(views[i], "byteLength", where);
    const std::size_t stride = optional_count(views[i], "byteStride", 4, where);
    const std::size_t available = state.buffers[buffer].size();
    if (offset > available || length > available - offset) {
      reject_at(where, "runs past the end of its buffer",
                fmt::format("{} + {} bytes", offset, length), fmt::format("at most {}", available));
    }
    if (stride < 4 || stride > 252 || stride % 4 != 0) {
      reject_at(where, "bad stride", std::to_string(stride), "a multiple of 4 from 4 to 252");
    }
  }
}

// `count` elements of `size` bytes must lie within the view, aligned to their components.
void check_range(const State& state, const Json& source, std::size_t count, std::size_t size,
                 std::size_t component, const Where& where) {
  const std::size_t index = required_index(source, "bufferView", state.count("bufferViews"), where);
  const Json& view = state.element("bufferViews", index);
  const std::size_t stride = view.value("byteStride", size);
  const std::size_t offset = optional_count(source, "byteOffset", 0, where);
  const std::size_t length = view["byteLength"].get<std::size_t>();
  if (stride < size) {
    reject_at(where, "elements larger than the stride of their view", std::to_string(size),
              fmt::format("at most {} bytes", stride));
  }
  // offset + (count - 1) stride + size <= length, without overflow
  const std::size_t available = offset > length ? 0 : length - offset;
  if (offset > length ||
      (count > 0 && (size > available || count - 1 > (available - size) / stride))) {
    reject_at(where, "runs past the end of its buffer view",
              fmt::format("{} elements from byte {}", count, offset),
              fmt::format("a view of more than {} bytes", length));
  }
  if ((offset + view.value("byteOffset", std::size_t{0})) % component != 0) {
    reject_at(where, "not aligned to its components", fmt::format("offset {}", offset),
              fmt::format("a multiple of {} bytes", component));
  }
}

void check_sparse(const State& state, const Json& accessor, std::size_t size, std::size_t component,
                  const Where& where) {
  const Json* sparse = find(accessor, "sparse");
  if (!sparse) return;
  const std::size_t count = required_count(*sparse, "count", where);
  const Json *indices = find(*sparse, "indices"), *values = find(*sparse, "values");
  if (!indices || !values) reject_at(where, "sparse without indices or values");
  if (count > accessor["count"].get<std::size_t>()) {
    reject_at(where, "more sparse elements than elements", std::to_string(count));
  }
  // tinygltf has ints for these
  for (const std::size_t number : {count, optional_count(*indices, "byteOffset", 0, where),
                                   optional_count(*values, "byteOffset", 0, where)}) {
    if (number > std::numeric_limits<int>::max()) {
      reject_at(where, "sparse data too large", std::to_string(number));
    }
  }
  const std::size_t type = required_count(*indices, "componentType", where);
  if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
      type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
      type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
    reject_at(where, "bad type of sparse indices", std::to_string(type));
  }
  check_range(state, *indices, count, component_bytes(type), component_bytes(type), where);
  check_range(state, *values, count, size, component, where);
}

void check_accessors(const State& state) {
  const Json& accessors = array_of(state.root, "accessors");
  std::size_t zero_bytes = 0;
  for (std::size_t i = 0; i < accessors.size(); ++i) {
    const Json& accessor = accessors[i];
    const Where where = state.where("accessor", i);
    const std::size_t count = required_count(accessor, "count", where);
    const std::size_t component_type = required_count(accessor, "componentType", where);
    const std::size_t component = component_bytes(component_type);
    const std::string type = optional_string(accessor, "type", where);
    if (component == 0) reject_at(where, "unknown component type");
    if (type_code(type) < 0) reject_at(where, "unknown type", type);
    optional_bool(accessor, "normalized", where);
    const std::size_t size = element_bytes(static_cast<int>(component_type), type_code(type));
    if (accessor.contains("bufferView")) {
      check_range(state, accessor, count, size, component, where);
    } else if (count > kMaxZeroCount || (zero_bytes += count * size) > kMaxZeroBytes) {
      reject_at(where, "too many elements without data", std::to_string(count),
                fmt::format("at most {}, and {} bytes in all", kMaxZeroCount, kMaxZeroBytes));
    }
    check_sparse(state, accessor, size, component, where);
  }
}

// Of an accessor that check_accessors has passed.
std::size_t accessor_count(const State& state, std::size_t accessor) {
  return state.element("accessors", accessor).at("count").get<std::size_t>();
}

void check_attributes(const State& state, const Json& attributes, std::optional<std::size_t> count,
                      const Where& where) {
  if (!attributes.is_object()) reject_at(where, "attributes are no object");
  for (const auto& [name, value] : attributes.items()) {
    const std::size_t accessor =
        required_index(attributes, name.c_str(), state.count("accessors"), where);
    if (!count) count = accessor_count(state, accessor);
    if (accessor_count(state, accessor) != *count) {
      reject_at(where, "attributes of different length", name,
                std::to_string(*count) + " elements");
    }
  }
}

void check_primitive(const State& state, const Json& primitive, const Where& where) {
  if (!primitive.is_object()) reject_at(where, "not an object");
  const Json* attributes = find(primitive, "attributes");
  if (!attributes || !attributes->is_object()) reject_at(where, "no attributes");
  if (!attributes->contains("POSITION")) reject_at(where, "no positions");
  check_attributes(state, *attributes, std::nullopt, where);
  optional_index(primitive, "indices", state.count("accessors"), where);
  optional_index(primitive, "material", state.count("materials"), where);
  optional_index(primitive, "mode", 7, where);
  const Json& targets = array_of(primitive, "targets");
  if (!targets.is_array()) reject_at(where, "targets are no array");
  const std::size_t count = accessor_count(state, (*attributes)["POSITION"].get<std::size_t>());
  for (const Json& target : targets) check_attributes(state, target, count, where);
}

void check_meshes(const State& state) {
  const Json& meshes = array_of(state.root, "meshes");
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const Json* primitives = find(meshes[m], "primitives");
    const Where where = state.where("mesh", m);
    if (!primitives || !primitives->is_array()) reject_at(where, "no primitives");
    for (std::size_t p = 0; p < primitives->size(); ++p) {
      check_primitive(state, (*primitives)[p],
                      {state.file, fmt::format("mesh {}: primitive {}", m, p)});
    }
  }
}

void check_materials(const State& state) {
  for (std::size_t i = 0; i < state.count("textures"); ++i) {
    const Json& texture = state.element("textures", i);
    optional_index(texture, "source", state.count("images"), state.where("texture", i));
    optional_index(texture, "sampler", state.count("samplers"), state.where("texture", i));
  }
  for (std::size_t i = 0; i < state.count("materials"); ++i) {
    const Where where = state.where("material", i);
    const Json& material = state.element("materials", i);
    optional_string(material, "name", where);
    optional_bool(material, "doubleSided", where);
    const Json* pbr = find(material, "pbrMetallicRoughness");
    if (!pbr) continue;
    check_numbers(*pbr, "baseColorFactor", 4, where);
    for (const char* name : {"baseColorTexture", "metallicRoughnessTexture"}) {
      const Json* info = find(*pbr, name);
      if (!info) continue;
      required_index(*info, "index", state.count("textures"), where);
      optional_index(*info, "texCoord", kMaxTexcoordSets, where);
    }
  }
}

void check_images(const State& state) {
  const Json& images = array_of(state.root, "images");
  for (std::size_t i = 0; i < images.size(); ++i) {
    required_index(images[i], "bufferView", state.count("bufferViews"), state.where("image", i));
  }
}

}  // namespace

void check_document(const State& state) {
  check_arrays(state);
  check_required_extensions(state);
  check_views(state);
  check_accessors(state);
  check_meshes(state);
  check_materials(state);
  check_images(state);
  check_nodes(state);
  check_size(state);
}

}  // namespace prt::gltf
