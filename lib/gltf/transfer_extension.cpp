// PRTKIT_precomputed_transfer: docs/extensions/PRTKIT_precomputed_transfer/README.md.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/checked.h"
#include "core/error.h"
#include "gltf/accessor.h"

namespace prt::gltf {

namespace {

constexpr const char* kClusterAttribute = "_PRT_CLUSTER";
constexpr int kConventions = 1;  // version of the conventions of the specification
constexpr int kMaxBandCount = 16, kMaxRowCount = 256, kMaxClusterCount = 65536,
              kMaxComponentCount = 256;

std::string weights_attribute(std::size_t group) { return fmt::format("_PRT_WEIGHTS_{}", group); }
std::size_t weight_groups(std::size_t component_count) { return (component_count + 3) / 4; }

[[noreturn]] void reject(const Where& where, const std::string& what, const std::string& found,
                         const std::string& expected) {
  throw_bad_input(what, {.file = where.file,
                         .element = where.element,
                         .found = found,
                         .expected = expected,
                         .advice = "Bake the file again."});
}

// A whole number of an object of the extension.
int read_limited(const tinygltf::Value& object, const char* key, int least, int most,
                 const Where& where) {
  const tinygltf::Value& value = object.Get(key);
  const int number = value.IsInt() ? value.Get<int>() : -1;
  if (number < least || number > most) {
    reject(where, key, value.IsInt() ? std::to_string(number) : "no whole number",
           fmt::format("{} to {}", least, most));
  }
  return number;
}

std::string read_string(const tinygltf::Value& object, const char* key, const Where& where) {
  if (!object.Has(key)) return {};
  const tinygltf::Value& value = object.Get(key);
  if (!value.IsString()) reject(where, key, "something else", "a string");
  return value.Get<std::string>();
}

void check_type(const tinygltf::Accessor& accessor, int type, int component_type,
                const std::string& name, const Where& where) {
  if (accessor.type == type && accessor.componentType == component_type && !accessor.normalized) {
    return;
  }
  reject(where, name, "an accessor of another type", "the type that the extension specifies");
}

void check_finite(const std::vector<float>& values, const std::string& name, const Where& where) {
  if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); })) {
    reject(where, name, "a number that is not finite", "finite numbers");
  }
}

// `count` finite floats of the accessor that `object` names.
std::vector<float> read_table(const Model& model, const tinygltf::Value& object, const char* key,
                              std::size_t count, const Where& where) {
  const int last = static_cast<int>(model.accessors.size()) - 1;
  const int index = read_limited(object, key, 0, last, where);
  const tinygltf::Accessor& accessor = accessor_of(model, index);
  check_type(accessor, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_FLOAT, key, where);
  if (accessor.count != count) {
    reject(where, key, fmt::format("{} elements", accessor.count), std::to_string(count));
  }
  std::vector<float> values = read_floats(model, index);
  check_finite(values, key, where);
  return values;
}

PrecomputedTransfer read_header(const Model& model, const tinygltf::Value& header,
                                const Where& where) {
  PrecomputedTransfer transfer;
  read_limited(header, "conventions", kConventions, kConventions, where);
  transfer.band_count = read_limited(header, "bandCount", 1, kMaxBandCount, where);
  transfer.row_count = read_limited(header, "rowCount", 1, kMaxRowCount, where);
  transfer.channel_count = read_limited(header, "channelCount", 1, 3, where);
  if (transfer.channel_count == 2) reject(where, "channelCount", "2", "1 or 3");
  transfer.brdf = read_string(header, "brdf", where);
  transfer.mesh_hash = read_string(header, "meshHash", where);
  cpca::Encoding& encoding = transfer.encoding;
  encoding.cluster_count = read_limited(header, "clusterCount", 1, kMaxClusterCount, where);
  encoding.component_count = read_limited(header, "componentCount", 0, kMaxComponentCount, where);
  encoding.dimension =
      transfer.channel_count * transfer.row_count * transfer.band_count * transfer.band_count;
  const auto mean_size = static_cast<std::size_t>(encoding.cluster_count) *
                         static_cast<std::size_t>(encoding.dimension);
  encoding.means = read_table(model, header, "means", mean_size, where);
  if (encoding.component_count > 0) {
    const auto basis_size =
        checked_multiply(mean_size, static_cast<std::size_t>(encoding.component_count));
    encoding.bases = read_table(model, header, "bases", basis_size, where);
  }
  return transfer;
}

// The accessor of an attribute that must be there.
int read_attribute(const tinygltf::Primitive& primitive, const std::string& name,
                   const Where& where) {
  const auto found = primitive.attributes.find(name);
  if (found == primitive.attributes.end()) reject(where, name, "nothing", "an accessor");
  return found->second;
}

void read_clusters(const Model& model, const tinygltf::Primitive& primitive,
                   cpca::Encoding& encoding, const Where& where) {
  const int index = read_attribute(primitive, kClusterAttribute, where);
  check_type(accessor_of(model, index), TINYGLTF_TYPE_SCALAR,
             TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, kClusterAttribute, where);
  for (const std::uint32_t cluster : read_unsigned(model, index)) {
    if (cluster >= static_cast<std::uint32_t>(encoding.cluster_count)) {
      reject(where, "cluster index past the last cluster", std::to_string(cluster),
             fmt::format("less than {}", encoding.cluster_count));
    }
    encoding.cluster_of_point.push_back(cluster);
  }
}

void read_weights(const Model& model, const tinygltf::Primitive& primitive,
                  std::size_t first_vertex, cpca::Encoding& encoding, const Where& where) {
  const auto components = static_cast<std::size_t>(encoding.component_count);
  const std::size_t count = encoding.cluster_of_point.size() - first_vertex;
  encoding.weights.resize(encoding.cluster_of_point.size() * components);
  for (std::size_t group = 0; group < weight_groups(components); ++group) {
    const std::string name = weights_attribute(group);
    const int index = read_attribute(primitive, name, where);
    check_type(accessor_of(model, index), TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_FLOAT, name,
               where);
    const std::vector<float> values = read_floats(model, index);
    check_finite(values, name, where);
    for (std::size_t i = 0; i < 4 * count; ++i) {
      const std::size_t vertex = first_vertex + i / 4, component = 4 * group + i % 4;
      if (component < components) {
        encoding.weights[vertex * components + component] = values[i];
      } else if (values[i] != 0.0f) {
        reject(where, name, "a weight of no component", "0 past the last component");
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
  primitive["attributes"][kClusterAttribute] =
      add_accessor(state,
                   {.component_type = TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                    .type = "SCALAR",
                    .count = clusters.size(),
                    .stride = kStride,
                    .target = TINYGLTF_TARGET_ARRAY_BUFFER},
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
        add_floats(state, "VEC4", values, TINYGLTF_TARGET_ARRAY_BUFFER);
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
  const struct {
    const char* what;
    int found, least, most;
  } limits[] = {{"bands", transfer.band_count, 1, kMaxBandCount},
                {"rows", transfer.row_count, 1, kMaxRowCount},
                {"clusters", encoding.cluster_count, 1, kMaxClusterCount},
                {"components", encoding.component_count, 0, kMaxComponentCount}};
  for (const auto& [what, found, least, most] : limits) {
    if (found >= least && found <= most) continue;
    throw_failed(fmt::format("number of {} that the extension has no room for", what),
                 {.found = std::to_string(found),
                  .expected = fmt::format("{} to {}", least, most),
                  .advice = fmt::format("Use fewer {}.", what)});
  }
  if (transfer.channel_count != 1 && transfer.channel_count != 3) {
    throw_failed("number of channels that the extension does not have",
                 {.found = std::to_string(transfer.channel_count), .expected = "1 or 3"});
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
  if (std::find(used.begin(), used.end(), kTransferExtension) == used.end())
    used.push_back(kTransferExtension);
}

}  // namespace

std::optional<PrecomputedTransfer> Document::precomputed_transfer() const {
  const Model model = read_model(*state_);
  const auto extension = model.extensions.find(kTransferExtension);
  if (extension == model.extensions.end()) return std::nullopt;
  const Where where{state_->file, kTransferExtension};
  const tinygltf::Value& transfers = extension->second.Get("transfers");
  if (transfers.ArrayLen() != 1 || !transfers.Get(0).IsObject()) {
    reject(where, "transfers", std::to_string(transfers.ArrayLen()), "an array of one object");
  }
  PrecomputedTransfer transfer = read_header(model, transfers.Get(0), where);
  cpca::Encoding& encoding = transfer.encoding;
  for (const PrimitiveUse& use : list_primitives(model)) {
    const tinygltf::Primitive& primitive = primitive_of(model, use);
    const Where element = where_of(model, use);
    const auto reference = primitive.extensions.find(kTransferExtension);
    if (reference == primitive.extensions.end()) {
      reject(element, "no transfer", "nothing", kTransferExtension);
    }
    read_limited(reference->second, "transfer", 0, 0, element);
    const std::size_t first_vertex = encoding.cluster_of_point.size();
    read_clusters(model, primitive, encoding, element);
    read_weights(model, primitive, first_vertex, encoding, element);
  }
  encoding.point_count = encoding.cluster_of_point.size();
  return transfer;
}

void Document::set_precomputed_transfer(const PrecomputedTransfer& transfer) {
  const Model model = read_model(*state_);
  const std::vector<PrimitiveUse> uses = list_primitives(model);
  const auto vertex_count = [&](const PrimitiveUse& use) {
    const auto& primitive = primitive_of(model, use);
    return accessor_of(model, read_attribute(primitive, "POSITION", where_of(model, use))).count;
  };
  std::size_t total = 0;
  for (const PrimitiveUse& use : uses) total += vertex_count(use);
  check_writable(transfer, total);
  remove_precomputed_transfer();

  const cpca::Encoding& encoding = transfer.encoding;
  const auto components = static_cast<std::size_t>(encoding.component_count);
  Json header = make_header(*state_, transfer);
  make_object(state_->root, "extensions")[kTransferExtension]["transfers"] = Json::array({header});
  list_extension(state_->root);
  std::size_t first = 0;
  for (const PrimitiveUse& use : uses) {
    const std::size_t count = vertex_count(use);
    Json& primitive = primitive_of(*state_, use);
    write_clusters(*state_, primitive, std::span(encoding.cluster_of_point).subspan(first, count));
    write_weights(*state_, primitive,
                  std::span(encoding.weights).subspan(first * components, count * components),
                  components, count);
    make_object(primitive, "extensions")[kTransferExtension] = {{"transfer", 0}};
    first += count;
  }
}

void Document::remove_precomputed_transfer() { gltf::remove_precomputed_transfer(*state_); }

}  // namespace prt::gltf
