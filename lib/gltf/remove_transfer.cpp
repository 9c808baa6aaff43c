// Takes PRTKIT_precomputed_transfer out of a document, so that baking again does not make it grow.
#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "gltf/state.h"
#include "gltf/transfer_format.h"

namespace prt::gltf {

namespace {

using Numbers = std::set<std::size_t>;

// Every whole number in there: no fewer than the elements it refers to.
void collect_numbers(const Json& json, Numbers& numbers) {
  if (json.is_number_unsigned()) numbers.insert(json.get<std::size_t>());
  if (!json.is_structured()) return;
  for (const Json& child : json) collect_numbers(child, numbers);
}

// What refers to accessors and views, and what we do not know and so might, wherever it is.
void collect_references(const Json& json, Numbers& numbers) {
  if (!json.is_structured()) return;
  for (const auto& [key, child] : json.items()) {
    const bool may_refer = key == "meshes" || key == "skins" || key == "animations" ||
                           key == "extensions" || key == "extras";
    may_refer ? collect_numbers(child, numbers) : collect_references(child, numbers);
  }
}

// The views that accessors and images name, as often as they do.
std::multiset<std::size_t> views_in_use(const Json& root) {
  std::multiset<std::size_t> views;
  const auto add = [&](const Json& object) {
    if (const Json* view = find(object, "bufferView")) views.insert(view->get<std::size_t>());
  };
  for (const Json& image : array_of(root, "images")) add(image);
  for (const Json& accessor : array_of(root, "accessors")) {
    add(accessor);
    for (const Json& part : array_of(accessor, "sparse")) add(part);
  }
  return views;
}

// The bytes of views that are gone, the last first, go when they are the last of their buffer and
// no other view's.
void shorten_buffers(State& state, const std::vector<Json>& gone) {
  const auto range = [](const Json& view) {
    const std::size_t begin = view.value("byteOffset", std::size_t{0});
    return std::pair(begin, begin + view["byteLength"].get<std::size_t>());
  };
  std::vector<std::size_t> kept(state.buffers.size());
  for (const Json& view : array_of(state.root, "bufferViews")) {
    if (view.contains("extensions")) return;  // they may name a part of a buffer
    std::size_t& end = kept[view["buffer"].get<std::size_t>()];
    end = std::max(end, range(view).second);
  }
  for (const Json& view : gone) {
    const std::size_t buffer = view["buffer"].get<std::size_t>();
    const auto [begin, end] = range(view);
    if (begin < kept[buffer] || (end + 3) / 4 * 4 < state.buffers[buffer].size()) continue;
    state.buffers[buffer].resize(begin);
    state.root["buffers"][buffer]["byteLength"] = begin;
  }
}

void drop_last_accessors(State& state, const Numbers& dead) {
  Numbers referenced;
  collect_references(state.root, referenced);
  auto used = views_in_use(state.root);
  Json& accessors = make_array(state.root, "accessors");
  Json& views = make_array(state.root, "bufferViews");
  std::vector<Json> gone;
  while (accessors.size() > 1) {
    const std::size_t last = accessors.size() - 1;
    if (!dead.contains(last) || referenced.contains(last)) break;
    if (const Json* reference = find(accessors[last], "bufferView")) {
      const std::size_t view = reference->get<std::size_t>();
      used.erase(used.find(view));
      if (view + 1 == views.size() && !referenced.contains(view) && !used.contains(view)) {
        gone.push_back(views[view]);
        views.erase(view);
      }
    }
    accessors.erase(last);
  }
  shorten_buffers(state, gone);
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
    if (is_transfer_attribute(name)) {
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
      for (const char* key : {"means", "bases", "componentCounts", "superclusters"}) {
        if (const Json* accessor = find(transfer, key)) collect_numbers(*accessor, dead);
      }
    }
  }
  erase_extension(root);
  for (std::size_t m = 0; m < state.count("meshes"); ++m) {
    for (Json& primitive : root["meshes"][m]["primitives"]) {
      if (const Json* reference = find_transfer(primitive)) {
        if (const Json* weights = find(*reference, "weights")) collect_numbers(*weights, dead);
      }
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
