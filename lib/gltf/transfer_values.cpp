#include "gltf/transfer_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/checked.h"
#include "gltf/accessor.h"

namespace prt::gltf {

namespace {

constexpr std::size_t kMaxPaddedSize = std::size_t{1} << 28;

}  // namespace

void reject_transfer(const Where& where, const std::string& what, const std::string& found,
                     const std::string& expected) {
  reject_at(where, what, found, expected, "Bake the file again.");
}

int read_limited(const tinygltf::Value& object, const char* key, int least, int most,
                 const Where& where) {
  const tinygltf::Value& value = object.Get(key);
  const int number = value.IsInt() ? value.Get<int>() : -1;
  if (number < least || number > most) {
    reject_transfer(where, key, value.IsInt() ? std::to_string(number) : "no whole number",
                    fmt::format("{} to {}", least, most));
  }
  return number;
}

std::string read_string(const tinygltf::Value& object, const char* key, const Where& where) {
  if (!object.Has(key)) return {};
  const tinygltf::Value& value = object.Get(key);
  if (!value.IsString()) reject_transfer(where, key, "something else", "a string");
  return value.Get<std::string>();
}

void check_type(const tinygltf::Accessor& accessor, int type, int component_type, bool normalized,
                const std::string& name, const Where& where) {
  if (accessor.type == type && accessor.componentType == component_type &&
      accessor.normalized == normalized) {
    return;
  }
  reject_transfer(where, name, "an accessor of another type",
                  "the type that the extension specifies");
}

void check_finite(const std::vector<float>& values, const std::string& name, const Where& where) {
  if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); })) {
    reject_transfer(where, name, "a number that is not finite", "finite numbers");
  }
}

int read_accessor(const Model& model, const tinygltf::Value& object, const char* key,
                  const Where& where) {
  return read_limited(object, key, 0, static_cast<int>(model.accessors.size()) - 1, where);
}

void check_count(const tinygltf::Accessor& accessor, std::size_t count, const char* key,
                 const Where& where) {
  if (accessor.count == count) return;
  reject_transfer(where, key, fmt::format("{} elements", accessor.count), std::to_string(count));
}

std::vector<float> read_table(const Model& model, const tinygltf::Value& object, const char* key,
                              std::size_t count, const Where& where) {
  const int index = read_accessor(model, object, key, where);
  const tinygltf::Accessor& accessor = accessor_of(model, index);
  check_type(accessor, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_FLOAT, false, key, where);
  check_count(accessor, count, key, where);
  std::vector<float> values = read_floats(model, index);
  check_finite(values, key, where);
  return values;
}

std::vector<std::uint32_t> read_numbers(const Model& model, const tinygltf::Value& object,
                                        const char* key, std::size_t most_count,
                                        const Where& where) {
  const int index = read_accessor(model, object, key, where);
  const tinygltf::Accessor& accessor = accessor_of(model, index);
  check_type(accessor, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, false, key,
             where);
  if (accessor.count > most_count) {
    reject_transfer(where, key, fmt::format("{} elements", accessor.count),
                    fmt::format("at most {}", most_count));
  }
  return read_unsigned(model, index);
}

std::size_t padded_size(const Model& model, std::size_t count, const cpca::Encoding& encoding,
                        const char* key, const Where& where) {
  const std::size_t size =
      checked_multiply(count, static_cast<std::size_t>(encoding.component_count));
  const std::size_t most = std::min(model.state.limits.max_element_count, kMaxPaddedSize);
  if (!encoding.component_counts.empty() && size > most) {
    reject_transfer(where, key, fmt::format("{} numbers", size), fmt::format("at most {}", most));
  }
  return size;
}

int read_attribute(const tinygltf::Primitive& primitive, const std::string& name,
                   const Where& where) {
  const auto found = primitive.attributes.find(name);
  if (found == primitive.attributes.end()) reject_transfer(where, name, "nothing", "an accessor");
  return found->second;
}

}  // namespace prt::gltf
