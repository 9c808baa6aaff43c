// glTF's JSON and how its fields are read: every access names the element and checks the type.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace prt::gltf {

/// Keeps the order of keys, so that a file changes no more than it has to.
using Json = nlohmann::ordered_json;

/// For messages: the file, and "accessor 3".
struct Where {
  const std::string& file;
  std::string element;
};

/// Throws Error (bad_input) that names the place; what is empty is left out.
[[noreturn]] void reject_at(const Where& where, const std::string& what,
                            const std::string& found = {}, const std::string& expected = {},
                            const std::string& advice = {});

/// All throw Error (bad_input) when the field has another type or, in required_…, is missing.
const Json* find(const Json& object, const char* key);
std::size_t required_count(const Json& object, const char* key, const Where& where);
std::size_t optional_count(const Json& object, const char* key, std::size_t absent,
                           const Where& where);
std::string optional_string(const Json& object, const char* key, const Where& where);
bool optional_bool(const Json& object, const char* key, const Where& where);
/// A number below `limit` that refers to an element of an array.
std::optional<std::size_t> optional_index(const Json& object, const char* key, std::size_t limit,
                                          const Where& where);
std::size_t required_index(const Json& object, const char* key, std::size_t limit,
                           const Where& where);
/// The field, if there, is an array of exactly `count` numbers that are finite floats.
void check_numbers(const Json& object, const char* key, std::size_t count, const Where& where);

/// Top-level array of that name, empty when absent.
const Json& array_of(const Json& root, const char* name);
/// The same, made when absent.
Json& make_array(Json& root, const char* name);
Json& make_object(Json& parent, const char* name);
/// Makes room for the few keys that we may add to a document: until then, references to what is in
/// it stay good (this JSON type keeps an object's members in a vector).
void reserve_keys(Json& root);

}  // namespace prt::gltf
