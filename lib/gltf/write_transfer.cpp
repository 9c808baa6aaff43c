// PRTKIT_precomputed_transfer as it is written.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "core/error.h"
#include "core/exit_rows.h"
#include "gltf/accessor.h"
#include "gltf/transfer_format.h"

namespace prt::gltf {

namespace {

using cpca::WeightFormat;

bool is_adaptive(const cpca::Encoding& encoding) { return !encoding.component_counts.empty(); }

std::size_t add_numbers(State& state, std::span<const std::uint32_t> values,
                        std::size_t stride = sizeof(std::uint16_t), int target = 0) {
  Bytes bytes(values.size() * stride);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = static_cast<std::uint16_t>(values[i]);
    std::memcpy(&bytes[i * stride], &value, sizeof(value));
  }
  return add_accessor(state,
                      {.component_type = TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                       .type = "SCALAR",
                       .count = values.size(),
                       .stride = stride == sizeof(std::uint16_t) ? 0 : stride,
                       .target = target},
                      std::move(bytes));
}

void write_clusters(State& state, Json& primitive, std::span<const std::uint32_t> clusters) {
  constexpr std::size_t kStride = 4;  // glTF wants attributes at multiples of 4 bytes
  primitive["attributes"][kClusterAttribute] =
      add_numbers(state, clusters, kStride, TINYGLTF_TARGET_ARRAY_BUFFER);
}

std::size_t add_weights(State& state, WeightFormat format, const char* type,
                        std::span<const float> values, int target) {
  return add_accessor(state,
                      {.component_type = component_type_of(format),
                       .type = type,
                       .count = values.size() / component_count(type_code(type)),
                       .target = target,
                       .normalized = cpca::is_normalized(format)},
                      cpca::stored_weights(format, values));
}

void write_weight_attributes(State& state, Json& primitive, const PrecomputedTransfer& transfer,
                             std::size_t first, std::size_t count) {
  const auto components = static_cast<std::size_t>(transfer.encoding.component_count);
  const float* const weights = transfer.encoding.weights.data() + first * components;
  for (std::size_t group = 0; group < weight_group_count(transfer.encoding.component_count);
       ++group) {
    std::vector<float> values(4 * count, 0.0f);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t c = 4 * group; c < std::min(4 * group + 4, components); ++c) {
        values[4 * i + c - 4 * group] = weights[i * components + c];
      }
    }
    primitive["attributes"][weights_attribute(group)] =
        add_weights(state, transfer.weight_format, "VEC4", values, TINYGLTF_TARGET_ARRAY_BUFFER);
  }
}

// Of adaptive encodings, without padding; nothing when there are none.
void write_packed_weights(State& state, Json& reference, const PrecomputedTransfer& transfer,
                          std::size_t first, std::size_t count) {
  const cpca::Encoding& encoding = transfer.encoding;
  const auto components = static_cast<std::size_t>(encoding.component_count);
  std::vector<float> packed;
  for (std::size_t p = first; p < first + count; ++p) {
    const auto row = encoding.weights.begin() + static_cast<std::ptrdiff_t>(p * components);
    packed.insert(packed.end(), row,
                  row + static_cast<std::ptrdiff_t>(packed_weight_count(encoding, p, p + 1)));
  }
  if (packed.empty()) return;
  reference["weights"] = add_weights(state, transfer.weight_format, "SCALAR", packed, 0);
}

std::vector<float> packed_bases(const cpca::Encoding& encoding) {
  if (!is_adaptive(encoding)) return encoding.bases;
  std::vector<float> packed;
  for (int k = 0; k < encoding.cluster_count; ++k) {
    for (int i = 0; i < encoding.component_count_of(k); ++i) {
      const auto basis = encoding.basis(k, i);
      packed.insert(packed.end(), basis.begin(), basis.end());
    }
  }
  return packed;
}

void check_limits(const PrecomputedTransfer& transfer) {
  const cpca::Encoding& encoding = transfer.encoding;
  const struct {
    const char* what;
    int found, least, most;
  } limits[] = {{"bands", transfer.band_count, 1, kMaxBandCount},
                {"clusters", encoding.cluster_count, 1, kMaxClusterCount},
                {"components", encoding.component_count, 0, kMaxComponentCount}};
  for (const auto& [what, found, least, most] : limits) {
    if (found >= least && found <= most) continue;
    throw_failed(fmt::format("number of {} that the extension has no room for", what),
                 {.found = std::to_string(found),
                  .expected = fmt::format("{} to {}", least, most),
                  .advice = fmt::format("Use fewer {}.", what)});
  }
  if (!is_exit_row_count(transfer.row_count)) {
    throw_failed("number of rows that the extension does not have",
                 {.found = std::to_string(transfer.row_count),
                  .expected = fmt::format("{} up to {}", kExitRowCounts, kMaxExitRowCount)});
  }
  if (transfer.channel_count != 1 && transfer.channel_count != 3) {
    throw_failed("number of channels that the extension does not have",
                 {.found = std::to_string(transfer.channel_count), .expected = "1 or 3"});
  }
}

void check_writable(const PrecomputedTransfer& transfer, std::size_t vertex_count) {
  const cpca::Encoding& encoding = transfer.encoding;
  if (encoding.point_count != vertex_count) {
    throw_failed(
        "compressed transfer of another number of vertices",
        {.found = std::to_string(encoding.point_count), .expected = std::to_string(vertex_count)});
  }
  check_limits(transfer);
  if (transfer.weight_format == WeightFormat::float32) return;
  const float least = cpca::is_normalized(transfer.weight_format) ? 0.0f : -cpca::kGreatestHalf;
  const float most = cpca::is_normalized(transfer.weight_format) ? 1.0f : cpca::kGreatestHalf;
  for (const float weight : encoding.weights) {
    if (weight >= least && weight <= most) continue;
    throw_failed(
        fmt::format("a weight beyond the range of {}", cpca::name_of(transfer.weight_format)),
        {.found = fmt::format("{}", weight), .expected = fmt::format("{} to {}", least, most)});
  }
}

int conventions_of(const PrecomputedTransfer& transfer) {
  if (transfer.weight_format == WeightFormat::float16) return 3;
  return is_adaptive(transfer.encoding) || transfer.weight_format != WeightFormat::float32 ? 2 : 1;
}

Json make_header(State& state, const PrecomputedTransfer& transfer) {
  const cpca::Encoding& encoding = transfer.encoding;
  Json json{{"conventions", conventions_of(transfer)},
            {"bandCount", transfer.band_count},
            {"rowCount", transfer.row_count},
            {"channelCount", transfer.channel_count},
            {"brdf", transfer.brdf},
            {"clusterCount", encoding.cluster_count},
            {"componentCount", encoding.component_count},
            {"means", add_floats(state, "SCALAR", encoding.means, 0)}};
  if (!transfer.mesh_hash.empty()) json["meshHash"] = transfer.mesh_hash;
  if (vector_count(encoding) > 0) {
    json["bases"] = add_floats(state, "SCALAR", packed_bases(encoding), 0);
  }
  if (is_adaptive(encoding)) {
    json["componentCounts"] = add_numbers(state, encoding.component_counts);
  }
  if (transfer.weight_format == WeightFormat::float16) json[kWeightTypeKey] = kHalfFloat;
  if (!transfer.first_clusters.empty()) {
    json["superclusters"] = add_numbers(state, transfer.first_clusters);
  }
  return json;
}

void list_extension(Json& root) {
  Json& used = make_array(root, "extensionsUsed");
  if (std::find(used.begin(), used.end(), kTransferExtension) == used.end())
    used.push_back(kTransferExtension);
}

std::size_t vertex_count(const Model& model, const PrimitiveUse& use) {
  const auto& attributes = primitive_of(model, use).attributes;
  const auto positions = attributes.find("POSITION");
  if (positions != attributes.end()) return accessor_of(model, positions->second).count;
  reject_at(where_of(model, use), "no positions");
}

}  // namespace

StoredBytes stored_bytes(const PrecomputedTransfer& transfer) {
  const cpca::Encoding& encoding = transfer.encoding;
  const std::size_t weight_count =
      is_adaptive(encoding)
          ? packed_weight_count(encoding, 0, encoding.point_count)
          : encoding.point_count * 4 * weight_group_count(encoding.component_count);
  const std::size_t table_size = encoding.component_counts.size() + transfer.first_clusters.size();
  return {.cluster_indices = 4 * encoding.point_count,
          .weights = weight_count * cpca::bytes_of(transfer.weight_format),
          .means = encoding.means.size() * sizeof(float),
          .bases =
              vector_count(encoding) * static_cast<std::size_t>(encoding.dimension) * sizeof(float),
          .tables = table_size * sizeof(std::uint16_t)};
}

void Document::set_precomputed_transfer(const PrecomputedTransfer& transfer) {
  const Model model = read_model(*state_);
  const std::vector<PrimitiveUse> uses = list_primitives(model);
  std::size_t total = 0;
  for (const PrimitiveUse& use : uses) total += vertex_count(model, use);
  check_writable(transfer, total);
  remove_precomputed_transfer();

  const cpca::Encoding& encoding = transfer.encoding;
  Json header = make_header(*state_, transfer);
  make_object(state_->root, "extensions")[kTransferExtension]["transfers"] = Json::array({header});
  list_extension(state_->root);
  std::size_t first = 0;
  for (const PrimitiveUse& use : uses) {
    const std::size_t count = vertex_count(model, use);
    Json& primitive = primitive_of(*state_, use);
    write_clusters(*state_, primitive, std::span(encoding.cluster_of_point).subspan(first, count));
    Json reference{{"transfer", 0}};
    if (is_adaptive(encoding)) {
      write_packed_weights(*state_, reference, transfer, first, count);
    } else {
      write_weight_attributes(*state_, primitive, transfer, first, count);
    }
    make_object(primitive, "extensions")[kTransferExtension] = std::move(reference);
    first += count;
  }
}

void Document::remove_precomputed_transfer() { gltf::remove_precomputed_transfer(*state_); }

}  // namespace prt::gltf
