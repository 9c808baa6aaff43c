// Values of PRTKIT_precomputed_transfer's objects and accessors, checked as they are read. All
// throw Error (bad_input) naming the value, what was found and what was expected.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cpca/encoding.h"
#include "gltf/model.h"

namespace prt::gltf {

[[noreturn]] void reject_transfer(const Where& where, const std::string& what,
                                  const std::string& found, const std::string& expected);

/// A whole number of an object of the extension.
int read_limited(const tinygltf::Value& object, const char* key, int least, int most,
                 const Where& where);
/// A string of it; "" when absent.
std::string read_string(const tinygltf::Value& object, const char* key, const Where& where);
/// The accessor that it names.
int read_accessor(const Model& model, const tinygltf::Value& object, const char* key,
                  const Where& where);
/// `count` finite floats.
std::vector<float> read_table(const Model& model, const tinygltf::Value& object, const char* key,
                              std::size_t count, const Where& where);
/// Small whole numbers, at most `most_count` of them.
std::vector<std::uint32_t> read_numbers(const Model& model, const tinygltf::Value& object,
                                        const char* key, std::size_t most_count,
                                        const Where& where);
/// The accessor of an attribute that must be there.
int read_attribute(const tinygltf::Primitive& primitive, const std::string& name,
                   const Where& where);

void check_type(const tinygltf::Accessor& accessor, int type, int component_type, bool normalized,
                const std::string& name, const Where& where);
void check_count(const tinygltf::Accessor& accessor, std::size_t count, const char* key,
                 const Where& where);
void check_finite(const std::vector<float>& values, const std::string& name, const Where& where);

/// `count` times componentCount: a few component counts in a small file may ask for much padding.
std::size_t padded_size(const Model& model, std::size_t count, const cpca::Encoding& encoding,
                        const char* key, const Where& where);

}  // namespace prt::gltf
