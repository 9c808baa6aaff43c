#include "gltf/json.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"

namespace prt::gltf {

namespace {

[[noreturn]] void reject(const char* key, const Where& where, const std::string& found,
                         const std::string& expected) {
  reject_at(where, fmt::format("bad \"{}\"", key), found, expected);
}

}  // namespace

void reject_at(const Where& where, const std::string& what, const std::string& found,
               const std::string& expected, const std::string& advice) {
  throw_bad_input(what, {.file = where.file,
                         .element = where.element,
                         .found = found,
                         .expected = expected,
                         .advice = advice});
}

const Json* find(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

std::size_t optional_count(const Json& object, const char* key, std::size_t absent,
                           const Where& where) {
  const Json* value = find(object, key);
  if (!value) return absent;
  const bool count = value->is_number_unsigned() ||
                     (value->is_number_integer() && value->get<std::int64_t>() >= 0);
  if (!count) {
    reject(key, where, value->type_name(), "an integer, 0 or more");
  }
  return value->get<std::size_t>();
}

std::size_t required_count(const Json& object, const char* key, const Where& where) {
  if (!find(object, key)) reject(key, where, "nothing", "an integer, 0 or more");
  return optional_count(object, key, 0, where);
}

std::string optional_string(const Json& object, const char* key, const Where& where) {
  const Json* value = find(object, key);
  if (!value) return {};
  if (!value->is_string()) reject(key, where, value->type_name(), "a string");
  return value->get<std::string>();
}

bool optional_bool(const Json& object, const char* key, const Where& where) {
  const Json* value = find(object, key);
  if (!value) return false;
  if (!value->is_boolean()) reject(key, where, value->type_name(), "true or false");
  return value->get<bool>();
}

std::optional<std::size_t> optional_index(const Json& object, const char* key, std::size_t limit,
                                          const Where& where) {
  if (!find(object, key)) return std::nullopt;
  return required_index(object, key, limit, where);
}

std::size_t required_index(const Json& object, const char* key, std::size_t limit,
                           const Where& where) {
  const std::size_t index = required_count(object, key, where);
  if (index >= limit) {
    reject(key, where, std::to_string(index), fmt::format("less than {}", limit));
  }
  return index;
}

void check_numbers(const Json& object, const char* key, std::size_t count, const Where& where) {
  const Json* values = find(object, key);
  if (!values) return;
  const std::string expected = fmt::format("{} finite numbers", count);
  if (!values->is_array() || values->size() != count) {
    reject(key, where, values->type_name(), expected);
  }
  for (const Json& value : *values) {
    if (!value.is_number()) reject(key, where, value.type_name(), expected);
    if (!(std::abs(value.get<double>()) <= std::numeric_limits<float>::max())) {
      reject(key, where, value.dump(), expected);
    }
  }
}

const Json& array_of(const Json& root, const char* name) {
  static const Json empty = Json::array();
  const Json* found = find(root, name);
  return found ? *found : empty;
}

Json& make_array(Json& root, const char* name) {
  if (!root.contains(name)) root[name] = Json::array();
  return root[name];
}

Json& make_object(Json& parent, const char* name) {
  if (!parent.contains(name)) parent[name] = Json::object();
  return parent[name];
}

void reserve_keys(Json& root) {
  auto& members = root.get_ref<Json::object_t&>();
  members.reserve(members.size() + 32);
}

}  // namespace prt::gltf
