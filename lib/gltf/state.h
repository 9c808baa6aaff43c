// What a Document holds: the JSON as it was read, and the bytes of its buffers. Changing and
// writing the JSON itself is what lets everything that prtkit does not know survive; tinygltf's
// model, which is what is read (gltf/model.h), wraps large integers and drops nulls, empty arrays
// and some extras and extensions.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "gltf/document.h"
#include "gltf/json.h"
#include "gltf/precomputed_transfer.h"

namespace prt::gltf {

using Bytes = std::vector<std::byte>;

struct Document::State {
  Json root;
  std::vector<Bytes> buffers;  ///< one a glTF buffer, whole
  std::string file;            ///< for messages
  Limits limits;

  Where where(const char* kind, std::size_t index) const {
    return {file, std::string(kind) + " " + std::to_string(index)};
  }
  std::size_t count(const char* array) const { return array_of(root, array).size(); }
  const Json& element(const char* array, std::size_t i) const { return root.at(array).at(i); }
};

using State = Document::State;

/// The extension in the root or in a primitive; null: none.
const Json* find_transfer(const Json& object);
/// Takes it out, everywhere, with its accessors where they are the last of the document and nothing
/// else can refer to them.
void remove_precomputed_transfer(State& state);

}  // namespace prt::gltf
