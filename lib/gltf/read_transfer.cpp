// PRTKIT_precomputed_transfer as a file has it: everything is checked here.
#include <fmt/format.h>

#include <algorithm>

#include "core/exit_rows.h"
#include "gltf/accessor.h"
#include "gltf/document.h"
#include "gltf/transfer_format.h"
#include "gltf/transfer_values.h"
#include "gltf/weight_reader.h"

namespace prt::gltf {

namespace {

void read_component_counts(const Model& model, const tinygltf::Value& header,
                           cpca::Encoding& encoding, const Where& where) {
  const char* const key = "componentCounts";
  const auto clusters = static_cast<std::size_t>(encoding.cluster_count);
  encoding.component_counts = read_numbers(model, header, key, clusters, where);
  check_count(accessor_of(model, read_accessor(model, header, key, where)), clusters, key, where);
  const auto most =
      *std::max_element(encoding.component_counts.begin(), encoding.component_counts.end());
  if (most > static_cast<std::uint32_t>(encoding.component_count)) {
    reject_transfer(where, key, std::to_string(most), "at most componentCount");
  }
}

void read_superclusters(const Model& model, const tinygltf::Value& header,
                        PrecomputedTransfer& transfer, const Where& where) {
  const char* const key = "superclusters";
  const auto clusters = static_cast<std::size_t>(transfer.encoding.cluster_count);
  std::vector<std::uint32_t>& first = transfer.first_clusters;
  first = read_numbers(model, header, key, clusters, where);
  const bool rises =
      std::adjacent_find(first.begin(), first.end(), std::greater_equal<>()) == first.end();
  if (first.empty() || first.front() != 0 || first.back() >= clusters || !rises) {
    reject_transfer(where, key, "another order", "clusters that rise from 0");
  }
}

// Basis vectors as they are stored, without those that a cluster does not have, put where the
// encoding has them.
std::vector<float> padded_bases(const cpca::Encoding& encoding, std::vector<float> packed) {
  if (encoding.component_counts.empty()) return packed;
  const auto n = static_cast<std::size_t>(encoding.dimension);
  const auto components = static_cast<std::size_t>(encoding.component_count);
  std::vector<float> padded(encoding.means.size() * components);
  auto from = packed.begin();
  for (std::size_t k = 0; k < encoding.component_counts.size(); ++k) {
    const auto count = static_cast<std::ptrdiff_t>(encoding.component_counts[k] * n);
    std::copy_n(from, count, padded.begin() + static_cast<std::ptrdiff_t>(k * components * n));
    from += count;
  }
  return padded;
}

// Without one the accessors of the weights tell.
void read_weight_type(const tinygltf::Value& header, int conventions, PrecomputedTransfer& transfer,
                      const Where& where) {
  if (!header.Has(kWeightTypeKey)) return;
  if (conventions < 3) {
    reject_transfer(where, kWeightTypeKey, fmt::format("conventions {}", conventions),
                    "conventions 3");
  }
  read_limited(header, kWeightTypeKey, kHalfFloat, kHalfFloat, where);
  transfer.weight_format = cpca::WeightFormat::float16;
}

PrecomputedTransfer read_header(const Model& model, const tinygltf::Value& header,
                                const Where& where) {
  PrecomputedTransfer transfer;
  const int conventions =
      read_limited(header, "conventions", kFirstConventions, kLastConventions, where);
  transfer.band_count = read_limited(header, "bandCount", 1, kMaxBandCount, where);
  transfer.row_count = read_limited(header, "rowCount", 1, kMaxExitRowCount, where);
  if (!is_exit_row_count(transfer.row_count)) {
    reject_transfer(where, "rowCount", std::to_string(transfer.row_count), kExitRowCounts);
  }
  transfer.channel_count = read_limited(header, "channelCount", 1, 3, where);
  if (transfer.channel_count == 2) reject_transfer(where, "channelCount", "2", "1 or 3");
  transfer.brdf = read_string(header, "brdf", where);
  transfer.mesh_hash = read_string(header, "meshHash", where);
  cpca::Encoding& encoding = transfer.encoding;
  encoding.cluster_count = read_limited(header, "clusterCount", 1, kMaxClusterCount, where);
  encoding.component_count = read_limited(header, "componentCount", 0, kMaxComponentCount, where);
  encoding.dimension =
      transfer.channel_count * transfer.row_count * transfer.band_count * transfer.band_count;
  const auto n = static_cast<std::size_t>(encoding.dimension);
  const auto mean_size = static_cast<std::size_t>(encoding.cluster_count) * n;
  encoding.means = read_table(model, header, "means", mean_size, where);
  if (header.Has("componentCounts")) {
    if (conventions < 2)
      reject_transfer(where, "componentCounts", "conventions 1", "conventions 2");
    read_component_counts(model, header, encoding, where);
  }
  read_weight_type(header, conventions, transfer, where);
  if (header.Has("superclusters")) read_superclusters(model, header, transfer, where);
  const std::size_t bases_size = padded_size(model, mean_size, encoding, "bases", where);
  if (const std::size_t vectors = vector_count(encoding); vectors > 0) {
    encoding.bases = padded_bases(encoding, read_table(model, header, "bases", vectors * n, where));
  } else {
    encoding.bases.resize(bases_size);
  }
  return transfer;
}

void read_clusters(const Model& model, const tinygltf::Primitive& primitive,
                   cpca::Encoding& encoding, const Where& where) {
  const int index = read_attribute(primitive, kClusterAttribute, where);
  check_type(accessor_of(model, index), TINYGLTF_TYPE_SCALAR,
             TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, false, kClusterAttribute, where);
  for (const std::uint32_t cluster : read_unsigned(model, index)) {
    if (cluster >= static_cast<std::uint32_t>(encoding.cluster_count)) {
      reject_transfer(where, "cluster index past the last cluster", std::to_string(cluster),
                      fmt::format("less than {}", encoding.cluster_count));
    }
    encoding.cluster_of_point.push_back(cluster);
  }
}

}  // namespace

std::optional<PrecomputedTransfer> Document::precomputed_transfer() const {
  const Model model = read_model(*state_);
  const auto extension = model.extensions.find(kTransferExtension);
  if (extension == model.extensions.end()) return std::nullopt;
  const Where where{state_->file, kTransferExtension};
  const tinygltf::Value& transfers = extension->second.Get("transfers");
  if (transfers.ArrayLen() != 1 || !transfers.Get(0).IsObject()) {
    reject_transfer(where, "transfers", std::to_string(transfers.ArrayLen()),
                    "an array of one object");
  }
  PrecomputedTransfer transfer = read_header(model, transfers.Get(0), where);
  cpca::Encoding& encoding = transfer.encoding;
  WeightReader weights(model, transfers.Get(0).Get("conventions").Get<int>(), transfer);
  for (const PrimitiveUse& use : list_primitives(model)) {
    const tinygltf::Primitive& primitive = primitive_of(model, use);
    const Where element = where_of(model, use);
    const auto reference = primitive.extensions.find(kTransferExtension);
    if (reference == primitive.extensions.end()) {
      reject_transfer(element, "no transfer", "nothing", kTransferExtension);
    }
    read_limited(reference->second, "transfer", 0, 0, element);
    const std::size_t first_vertex = encoding.cluster_of_point.size();
    read_clusters(model, primitive, encoding, element);
    weights.read(primitive, reference->second, first_vertex, element);
  }
  encoding.point_count = encoding.cluster_of_point.size();
  return transfer;
}

}  // namespace prt::gltf
