// PRTKIT_precomputed_transfer: docs/extensions/PRTKIT_precomputed_transfer/README.md.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/checked.h"
#include "core/error.h"
#include "gltf/accessor.h"
#include "gltf/state.h"

namespace prt::gltf {

namespace {

constexpr const char* kExtension = "PRTKIT_precomputed_transfer";
constexpr const char* kClusterAttribute = "_PRT_CLUSTER";
constexpr std::size_t kConventions = 1;  // version of the conventions of the specification
constexpr std::size_t kMaxBandCount = 16, kMaxRowCount = 256, kMaxClusterCount = 65536,
                      kMaxComponentCount = 256;

std::string weights_attribute(std::size_t group) { return fmt::format("_PRT_WEIGHTS_{}", group); }
std::size_t weight_groups(std::size_t component_count) { return (component_count + 3) / 4; }

const Json* extension_of(const Json& object) {
  const Json* extensions = find(object, "extensions");
  return extensions ? find(*extensions, kExtension) : nullptr;
}

[[noreturn]] void reject(const Where& where, const std::string& what, const std::string& found,
                         const std::string& expected) {
  throw_bad_input(what, {.file = where.file,
                         .element = where.element,
                         .found = found,
                         .expected = expected,
                         .advice = "Bake the file again."});
}

int read_limited(const Json& object, const char* key, std::size_t least, std::size_t most,
                 const Where& where) {
  const std::size_t value = required_count(object, key, where);
  if (value < least || value > most) {
    reject(where, key, std::to_string(value), fmt::format("{} to {}", least, most));
  }
  return static_cast<int>(value);
}

// `count` finite floats of the accessor that `object` names.
std::vector<float> read_table(const State& state, const Json& object, const char* key,
                              std::size_t count, const Where& where) {
  const std::size_t accessor = required_index(object, key, state.count("accessors"), where);
  const std::size_t found = accessor_count(state, accessor);
  if (found != count || accessor_components(state, accessor) != 1) {
    reject(where, key, fmt::format("{} elements", found), fmt::format("{} numbers", count));
  }
  std::vector<float> values = read_floats(state, accessor);
  if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); })) {
    reject(where, key, "a number that is not finite", "finite numbers");
  }
  return values;
}

PrecomputedTransfer read_header(const State& state, const Json& json, const Where& where) {
  PrecomputedTransfer transfer;
  if (required_count(json, "conventions", where) != kConventions) {
    reject(where, "unknown conventions", json["conventions"].dump(), std::to_string(kConventions));
  }
  transfer.band_count = read_limited(json, "bandCount", 1, kMaxBandCount, where);
  transfer.row_count = read_limited(json, "rowCount", 1, kMaxRowCount, where);
  transfer.channel_count = read_limited(json, "channelCount", 1, 3, where);
  if (transfer.channel_count == 2) reject(where, "channelCount", "2", "1 or 3");
  transfer.brdf = optional_string(json, "brdf", where);
  transfer.mesh_hash = optional_string(json, "meshHash", where);
  cpca::Encoding& encoding = transfer.encoding;
  encoding.cluster_count = read_limited(json, "clusterCount", 1, kMaxClusterCount, where);
  encoding.component_count = read_limited(json, "componentCount", 0, kMaxComponentCount, where);
  encoding.dimension =
      transfer.channel_count * transfer.row_count * transfer.band_count * transfer.band_count;
  const auto mean_size = static_cast<std::size_t>(encoding.cluster_count) *
                         static_cast<std::size_t>(encoding.dimension);
  encoding.means = read_table(state, json, "means", mean_size, where);
  if (encoding.component_count > 0) {
    const auto basis_size =
        checked_multiply(mean_size, static_cast<std::size_t>(encoding.component_count));
    encoding.bases = read_table(state, json, "bases", basis_size, where);
  }
  return transfer;
}

void read_clusters(const State& state, const Json& primitive, cpca::Encoding& encoding,
                   const Where& where) {
  const std::size_t accessor = required_index(primitive.at("attributes"), kClusterAttribute,
                                              state.count("accessors"), where);
  if (accessor_components(state, accessor) != 1) {
    reject(where, kClusterAttribute, "several components", "one");
  }
  for (const std::uint32_t cluster : read_unsigned(state, accessor)) {
    if (cluster >= static_cast<std::uint32_t>(encoding.cluster_count)) {
      reject(where, "cluster index past the last cluster", std::to_string(cluster),
             fmt::format("less than {}", encoding.cluster_count));
    }
    encoding.cluster_of_point.push_back(cluster);
  }
}

void read_weights(const State& state, const Json& primitive, std::size_t first_vertex,
                  cpca::Encoding& encoding, const Where& where) {
  const auto components = static_cast<std::size_t>(encoding.component_count);
  const std::size_t count = encoding.cluster_of_point.size() - first_vertex;
  encoding.weights.resize(encoding.cluster_of_point.size() * components);
  for (std::size_t group = 0; group < weight_groups(components); ++group) {
    const std::string name = weights_attribute(group);
    const std::size_t accessor =
        required_index(primitive.at("attributes"), name.c_str(), state.count("accessors"), where);
    if (accessor_components(state, accessor) != 4) reject(where, name, "another type", "VEC4");
    const std::vector<float> values = read_floats(state, accessor);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t c = 4 * group; c < std::min(4 * group + 4, components); ++c) {
        const float weight = values[4 * i + c - 4 * group];
        if (!std::isfinite(weight)) reject(where, name, "a weight that is not finite", "numbers");
        encoding.weights[(first_vertex + i) * components + c] = weight;
      }
    }
  }
}

void write_clusters(State& state, Json& primitive, std::span<const std::uint32_t> clusters) {
  constexpr std::size_t kStride = 4;  // glTF wants attributes at multiples of 4 bytes
  Bytes bytes(clusters.size() * kStride);
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    const auto cluster = static_cast<std::uint16_t>(clusters[i]);
    std::memcpy(&bytes[i * kStride], &cluster, sizeof(cluster));
  }
  primitive["attributes"][kClusterAttribute] = add_accessor(state,
                                                            {.component_type = kUnsignedShort,
                                                             .type = "SCALAR",
                                                             .count = clusters.size(),
                                                             .stride = kStride,
                                                             .target = kVertices},
                                                            std::move(bytes));
}

void write_weights(State& state, Json& primitive, std::span<const float> weights,
                   std::size_t components, std::size_t vertex_count) {
  for (std::size_t group = 0; group < weight_groups(components); ++group) {
    std::vector<float> values(4 * vertex_count, 0.0f);
    for (std::size_t i = 0; i < vertex_count; ++i) {
      for (std::size_t c = 4 * group; c < std::min(4 * group + 4, components); ++c) {
        values[4 * i + c - 4 * group] = weights[i * components + c];
      }
    }
    primitive["attributes"][weights_attribute(group)] =
        add_floats(state, "VEC4", values, kVertices);
  }
}

void check_writable(const PrecomputedTransfer& transfer, std::size_t vertex_count) {
  const cpca::Encoding& encoding = transfer.encoding;
  const auto fail = [](const std::string& what, std::size_t found, std::size_t expected) {
    throw_failed(what, {.found = std::to_string(found), .expected = std::to_string(expected)});
  };
  if (encoding.point_count != vertex_count) {
    fail("compressed transfer of another number of vertices", encoding.point_count, vertex_count);
  }
  if (static_cast<std::size_t>(encoding.cluster_count) > kMaxClusterCount) {
    throw_failed("too many clusters for glTF's 16-bit attributes",
                 {.found = std::to_string(encoding.cluster_count),
                  .expected = fmt::format("at most {}", kMaxClusterCount),
                  .advice = "Use fewer clusters."});
  }
}

Json make_header(State& state, const PrecomputedTransfer& transfer) {
  const cpca::Encoding& encoding = transfer.encoding;
  Json json{{"conventions", kConventions},
            {"bandCount", transfer.band_count},
            {"rowCount", transfer.row_count},
            {"channelCount", transfer.channel_count},
            {"brdf", transfer.brdf},
            {"meshHash", transfer.mesh_hash},
            {"clusterCount", encoding.cluster_count},
            {"componentCount", encoding.component_count},
            {"means", add_floats(state, "SCALAR", encoding.means, 0)}};
  if (encoding.component_count > 0) json["bases"] = add_floats(state, "SCALAR", encoding.bases, 0);
  return json;
}

void list_extension(Json& root) {
  Json& used = make_array(root, "extensionsUsed");
  if (std::find(used.begin(), used.end(), kExtension) == used.end()) used.push_back(kExtension);
}

}  // namespace

std::optional<PrecomputedTransfer> Document::precomputed_transfer() const {
  const Json* extension = extension_of(state_->root);
  if (!extension) return std::nullopt;
  const Where where{state_->file, kExtension};
  const Json& transfers = array_of(*extension, "transfers");
  if (!transfers.is_array() || transfers.size() != 1) {
    reject(where, "transfers", fmt::format("{}", transfers.size()), "exactly one");
  }
  PrecomputedTransfer transfer = read_header(*state_, transfers[0], where);
  cpca::Encoding& encoding = transfer.encoding;
  for (const PrimitiveUse& use : list_primitives(*state_)) {
    const Json& primitive = primitive_of(*state_, use);
    const Where element{state_->file,
                        fmt::format("mesh {}: primitive {}", use.mesh, use.primitive)};
    const Json* reference = extension_of(primitive);
    if (!reference) reject(element, "no transfer", "nothing", kExtension);
    required_index(*reference, "transfer", transfers.size(), element);
    const std::size_t first_vertex = encoding.cluster_of_point.size();
    read_clusters(*state_, primitive, encoding, element);
    read_weights(*state_, primitive, first_vertex, encoding, element);
  }
  encoding.point_count = encoding.cluster_of_point.size();
  return transfer;
}

void Document::set_precomputed_transfer(const PrecomputedTransfer& transfer) {
  const std::vector<PrimitiveUse> uses = list_primitives(*state_);
  const auto vertex_count = [&](const PrimitiveUse& use) {
    return accessor_count(*state_, primitive_of(*state_, use)["attributes"]["POSITION"]);
  };
  std::size_t total = 0;
  for (const PrimitiveUse& use : uses) total += vertex_count(use);
  check_writable(transfer, total);
  remove_precomputed_transfer();

  const cpca::Encoding& encoding = transfer.encoding;
  const auto components = static_cast<std::size_t>(encoding.component_count);
  Json header = make_header(*state_, transfer);
  make_object(state_->root, "extensions")[kExtension]["transfers"] = Json::array({header});
  list_extension(state_->root);
  std::size_t first = 0;
  for (const PrimitiveUse& use : uses) {
    const std::size_t count = vertex_count(use);
    Json& primitive = primitive_of(*state_, use);
    write_clusters(*state_, primitive, std::span(encoding.cluster_of_point).subspan(first, count));
    write_weights(*state_, primitive,
                  std::span(encoding.weights).subspan(first * components, count * components),
                  components, count);
    make_object(primitive, "extensions")[kExtension] = {{"transfer", 0}};
    first += count;
  }
}

void remove_precomputed_transfer(State& state) {
  Json& root = state.root;
  const auto remove_from = [](Json& object) {
    if (!extension_of(object)) return;
    object["extensions"].erase(kExtension);
    if (object["extensions"].empty()) object.erase("extensions");
  };
  remove_from(root);
  if (root.contains("meshes")) {
    for (Json& mesh : root["meshes"]) {
      for (Json& primitive : mesh["primitives"]) {
        remove_from(primitive);
        Json kept = Json::object();
        for (const auto& [name, accessor] : primitive["attributes"].items()) {
          if (!name.starts_with("_PRT_")) kept[name] = accessor;
        }
        primitive["attributes"] = std::move(kept);
      }
    }
  }
  if (!root.contains("extensionsUsed")) return;
  std::erase(root["extensionsUsed"].get_ref<Json::array_t&>(), Json(kExtension));
  if (root["extensionsUsed"].empty()) root.erase("extensionsUsed");
}

void Document::remove_precomputed_transfer() { gltf::remove_precomputed_transfer(*state_); }

}  // namespace prt::gltf
