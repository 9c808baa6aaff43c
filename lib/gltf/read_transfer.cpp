// PRTKIT_precomputed_transfer as a file has it: everything is checked here.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/checked.h"
#include "core/error.h"
#include "gltf/accessor.h"
#include "gltf/transfer_format.h"

namespace prt::gltf {

namespace {

using cpca::WeightFormat;

constexpr std::size_t kMaxPaddedSize = std::size_t{1} << 28;

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

void check_type(const tinygltf::Accessor& accessor, int type, int component_type, bool normalized,
                const std::string& name, const Where& where) {
  if (accessor.type == type && accessor.componentType == component_type &&
      accessor.normalized == normalized) {
    return;
  }
  reject(where, name, "an accessor of another type", "the type that the extension specifies");
}

void check_finite(const std::vector<float>& values, const std::string& name, const Where& where) {
  if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); })) {
    reject(where, name, "a number that is not finite", "finite numbers");
  }
}

// The accessor that an object of the extension names.
int read_accessor(const Model& model, const tinygltf::Value& object, const char* key,
                  const Where& where) {
  return read_limited(object, key, 0, static_cast<int>(model.accessors.size()) - 1, where);
}

void check_count(const tinygltf::Accessor& accessor, std::size_t count, const char* key,
                 const Where& where) {
  if (accessor.count == count) return;
  reject(where, key, fmt::format("{} elements", accessor.count), std::to_string(count));
}

// `count` finite floats.
std::vector<float> read_table(const Model& model, const tinygltf::Value& object, const char* key,
                              std::size_t count, const Where& where) {
  const int index = read_accessor(model, object, key, where);
  const tinygltf::Accessor& accessor = accessor_of(model, index);
  check_type(accessor, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_FLOAT, false, key, where);
  check_count(accessor, count, key, where);
  std::vector<float> values = read_floats(model, index);
  check_finite(values, key, where);
  return values;
}

// Small whole numbers, at most `most_count` of them.
std::vector<std::uint32_t> read_numbers(const Model& model, const tinygltf::Value& object,
                                        const char* key, std::size_t most_count,
                                        const Where& where) {
  const int index = read_accessor(model, object, key, where);
  const tinygltf::Accessor& accessor = accessor_of(model, index);
  check_type(accessor, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, false, key,
             where);
  if (accessor.count > most_count) {
    reject(where, key, fmt::format("{} elements", accessor.count),
           fmt::format("at most {}", most_count));
  }
  return read_unsigned(model, index);
}

void read_component_counts(const Model& model, const tinygltf::Value& header,
                           cpca::Encoding& encoding, const Where& where) {
  const char* const key = "componentCounts";
  const auto clusters = static_cast<std::size_t>(encoding.cluster_count);
  encoding.component_counts = read_numbers(model, header, key, clusters, where);
  check_count(accessor_of(model, read_accessor(model, header, key, where)), clusters, key, where);
  const auto most =
      *std::max_element(encoding.component_counts.begin(), encoding.component_counts.end());
  if (most > static_cast<std::uint32_t>(encoding.component_count)) {
    reject(where, key, std::to_string(most), "at most componentCount");
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
    reject(where, key, "another order", "clusters that rise from 0");
  }
}

// `count` times componentCount: a few component counts in a small file may ask for much padding.
std::size_t padded_size(const Model& model, std::size_t count, const cpca::Encoding& encoding,
                        const char* key, const Where& where) {
  const std::size_t size =
      checked_multiply(count, static_cast<std::size_t>(encoding.component_count));
  const std::size_t most = std::min(model.state.limits.max_element_count, kMaxPaddedSize);
  if (!encoding.component_counts.empty() && size > most) {
    reject(where, key, fmt::format("{} numbers", size), fmt::format("at most {}", most));
  }
  return size;
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

PrecomputedTransfer read_header(const Model& model, const tinygltf::Value& header,
                                const Where& where) {
  PrecomputedTransfer transfer;
  const int conventions =
      read_limited(header, "conventions", kFirstConventions, kLastConventions, where);
  transfer.band_count = read_limited(header, "bandCount", 1, kMaxBandCount, where);
  transfer.row_count = read_limited(header, "rowCount", 1, kMaxRowCount, where);
  if (!is_row_count(transfer.row_count)) {
    reject(where, "rowCount", std::to_string(transfer.row_count), "1, or n² or n² - 1");
  }
  transfer.channel_count = read_limited(header, "channelCount", 1, 3, where);
  if (transfer.channel_count == 2) reject(where, "channelCount", "2", "1 or 3");
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
    if (conventions < 2) reject(where, "componentCounts", "conventions 1", "conventions 2");
    read_component_counts(model, header, encoding, where);
  }
  if (header.Has("superclusters")) read_superclusters(model, header, transfer, where);
  const std::size_t bases_size = padded_size(model, mean_size, encoding, "bases", where);
  if (const std::size_t vectors = vector_count(encoding); vectors > 0) {
    encoding.bases = padded_bases(encoding, read_table(model, header, "bases", vectors * n, where));
  } else {
    encoding.bases.resize(bases_size);
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
             TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, false, kClusterAttribute, where);
  for (const std::uint32_t cluster : read_unsigned(model, index)) {
    if (cluster >= static_cast<std::uint32_t>(encoding.cluster_count)) {
      reject(where, "cluster index past the last cluster", std::to_string(cluster),
             fmt::format("less than {}", encoding.cluster_count));
    }
    encoding.cluster_of_point.push_back(cluster);
  }
}

/// Weights of one primitive after the other; all of the format of the first.
class WeightReader {
 public:
  WeightReader(const Model& model, int conventions, PrecomputedTransfer& transfer)
      : model_(model), conventions_(conventions), transfer_(transfer) {}

  void read(const tinygltf::Primitive& primitive, const tinygltf::Value& extension,
            std::size_t first_vertex, const Where& where) {
    cpca::Encoding& encoding = transfer_.encoding;
    encoding.weights.resize(
        padded_size(model_, encoding.cluster_of_point.size(), encoding, "weights", where));
    if (encoding.component_counts.empty()) {
      read_attributes(primitive, first_vertex, where);
    } else {
      read_packed(extension, first_vertex, where);
    }
  }

 private:
  // Finite floats, or normalised integers as shares of 1.
  std::vector<float> read_values(int index, int type, const std::string& name, const Where& where) {
    const tinygltf::Accessor& accessor = accessor_of(model_, index);
    for (const WeightFormat format :
         {WeightFormat::float32, WeightFormat::unorm16, WeightFormat::unorm8}) {
      if (accessor.componentType == component_type_of(format) && !known_) {
        known_ = true;
        transfer_.weight_format = format;
      }
    }
    const WeightFormat format = transfer_.weight_format;
    if (conventions_ < 2 && format != WeightFormat::float32) {
      reject(where, name, "normalised weights in conventions 1", "conventions 2");
    }
    check_type(accessor, type, component_type_of(format), format != WeightFormat::float32, name,
               where);
    std::vector<float> values = read_floats(model_, index);
    check_finite(values, name, where);
    return values;
  }

  void read_attributes(const tinygltf::Primitive& primitive, std::size_t first_vertex,
                       const Where& where) {
    cpca::Encoding& encoding = transfer_.encoding;
    const auto components = static_cast<std::size_t>(encoding.component_count);
    const std::size_t count = encoding.cluster_of_point.size() - first_vertex;
    for (std::size_t group = 0; group < weight_group_count(encoding.component_count); ++group) {
      const std::string name = weights_attribute(group);
      const std::vector<float> values =
          read_values(read_attribute(primitive, name, where), TINYGLTF_TYPE_VEC4, name, where);
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

  void read_packed(const tinygltf::Value& extension, std::size_t first_vertex, const Where& where) {
    cpca::Encoding& encoding = transfer_.encoding;
    const auto components = static_cast<std::size_t>(encoding.component_count);
    const std::size_t last_vertex = encoding.cluster_of_point.size();
    const std::size_t count = packed_weight_count(encoding, first_vertex, last_vertex);
    if (count == 0) return;
    const int index = read_accessor(model_, extension, "weights", where);
    check_count(accessor_of(model_, index), count, "weights", where);
    const std::vector<float> values = read_values(index, TINYGLTF_TYPE_SCALAR, "weights", where);
    auto from = values.begin();
    for (std::size_t p = first_vertex; p < last_vertex; ++p) {
      const auto own = static_cast<std::ptrdiff_t>(packed_weight_count(encoding, p, p + 1));
      std::copy_n(from, own,
                  encoding.weights.begin() + static_cast<std::ptrdiff_t>(p * components));
      from += own;
    }
  }

  const Model& model_;
  int conventions_;
  PrecomputedTransfer& transfer_;
  bool known_ = false;  // whether a primitive has told the format
};

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
  WeightReader weights(model, transfers.Get(0).Get("conventions").Get<int>(), transfer);
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
    weights.read(primitive, reference->second, first_vertex, element);
  }
  encoding.point_count = encoding.cluster_of_point.size();
  return transfer;
}

}  // namespace prt::gltf
