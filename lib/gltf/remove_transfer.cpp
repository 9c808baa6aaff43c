// Takes PRTKIT_precomputed_transfer out of a document, so that baking again does not make it grow.
#include <algorithm>
#include <set>

#include "gltf/state.h"

namespace prt::gltf {

namespace {

using Numbers = std::set<std::size_t>;

// Every whole number in there: no fewer than the elements it refers to.
void collect_numbers(const Json& json, Numbers& numbers) {
  if (json.is_number_unsigned()) numbers.insert(json.get<std::size_t>());
  if (!json.is_structured()) return;
  for (const Json& child : json) collect_numbers(child, numbers);
}

// What may refer to accessors and views, and what we do not know and so might.
Numbers references(const Json& root) {
  Numbers numbers;
  for (const char* name : {"meshes", "skins", "animations", "extensions"}) {
    collect_numbers(array_of(root, name), numbers);
  }
  for (const Json& node : array_of(root, "nodes")) {
    collect_numbers(array_of(node, "extensions"), numbers);
  }
  return numbers;
}

Numbers views_in_use(const Json& root) {
  Numbers views;
  const auto add = [&](const Json& object) {
    if (const Json* view = find(object, "bufferView")) collect_numbers(*view, views);
  };
  for (const Json& image : array_of(root, "images")) add(image);
  for (const Json& accessor : array_of(root, "accessors")) {
    add(accessor);
    for (const Json& part : array_of(accessor, "sparse")) add(part);
  }
  return views;
}

// The bytes of a view that is gone go when they are the last of their buffer and no other view's.
void shorten_buffer(State& state, const Json& gone) {
  const std::size_t buffer = gone["buffer"].get<std::size_t>();
  const std::size_t offset = gone.value("byteOffset", std::size_t{0});
  const std::size_t padded_end = offset + (gone["byteLength"].get<std::size_t>() + 3) / 4 * 4;
  if (padded_end < state.buffers[buffer].size()) return;
  for (const Json& view : state.root["bufferViews"]) {
    if (view.contains("extensions")) return;  // they may name a part of a buffer
    const std::size_t end =
        view.value("byteOffset", std::size_t{0}) + view["byteLength"].get<std::size_t>();
    if (view["buffer"] == buffer && end > offset) return;
  }
  state.buffers[buffer].resize(offset);
  state.root["buffers"][buffer]["byteLength"] = offset;
}

void drop_last_accessors(State& state, const Numbers& dead) {
  const Numbers referenced = references(state.root);
  Json& accessors = make_array(state.root, "accessors");
  Json& views = make_array(state.root, "bufferViews");
  while (accessors.size() > 1) {
    const std::size_t last = accessors.size() - 1;
    if (!dead.contains(last) || referenced.contains(last)) return;
    const Json accessor = accessors[last];
    accessors.erase(last);
    const std::size_t view = accessor.value("bufferView", views.size());
    if (view + 1 != views.size() || referenced.contains(view)) continue;
    if (views_in_use(state.root).contains(view)) continue;
    const Json gone = views[view];
    views.erase(view);
    shorten_buffer(state, gone);
  }
}

// The extension's own key of an object.
void erase_extension(Json& object) {
  if (!find_transfer(object)) return;
  object["extensions"].erase(kTransferExtension);
  if (object["extensions"].empty()) object.erase("extensions");
}

void erase_attributes(Json& primitive, Numbers& dead) {
  Json kept = Json::object();
  for (const auto& [name, accessor] : primitive["attributes"].items()) {
    if (name.starts_with("_PRT_")) {
      collect_numbers(accessor, dead);
    } else {
      kept[name] = accessor;
    }
  }
  primitive["attributes"] = std::move(kept);
}

}  // namespace

const Json* find_transfer(const Json& object) {
  const Json* extensions = find(object, "extensions");
  return extensions ? find(*extensions, kTransferExtension) : nullptr;
}

void remove_precomputed_transfer(State& state) {
  Json& root = state.root;
  Numbers dead;
  if (const Json* extension = find_transfer(root)) {
    for (const Json& transfer : array_of(*extension, "transfers")) {
      for (const char* key : {"means", "bases"}) {
        if (const Json* accessor = find(transfer, key)) collect_numbers(*accessor, dead);
      }
    }
  }
  erase_extension(root);
  for (std::size_t m = 0; m < state.count("meshes"); ++m) {
    for (Json& primitive : root["meshes"][m]["primitives"]) {
      erase_extension(primitive);
      erase_attributes(primitive, dead);
    }
  }
  if (!dead.empty()) drop_last_accessors(state, dead);
  if (!root.contains("extensionsUsed")) return;
  std::erase(root["extensionsUsed"].get_ref<Json::array_t&>(), Json(kTransferExtension));
  if (root["extensionsUsed"].empty()) root.erase("extensionsUsed");
}

}  // namespace prt::gltf
