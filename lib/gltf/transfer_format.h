// What reading and writing PRTKIT_precomputed_transfer share: names and limits of
// docs/extensions/PRTKIT_precomputed_transfer/README.md.
#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <numeric>
#include <string>
#include <string_view>

#include "gltf/precomputed_transfer.h"

namespace prt::gltf {

/// Versions of the conventions: the second has component counts and normalised weights, the third
/// half floats.
constexpr int kFirstConventions = 1, kLastConventions = 3;
constexpr const char *kClusterAttribute = "_PRT_CLUSTER", *kWeightsPrefix = "_PRT_WEIGHTS_";
/// Says that weights are half floats, by the number that OpenGL has for them: glTF has none.
constexpr const char* kWeightTypeKey = "weightComponentType";
constexpr int kHalfFloat = 5131;

inline std::string weights_attribute(std::size_t group) {
  return kWeightsPrefix + std::to_string(group);
}

/// The other attributes under _PRT_… are of other extensions.
inline bool is_transfer_attribute(std::string_view name) {
  return name == kClusterAttribute || name.starts_with(kWeightsPrefix);
}

inline std::size_t weight_group_count(int component_count) {
  return (static_cast<std::size_t>(component_count) + 3) / 4;
}

/// Of the accessors of weights; half floats lie in those of integers of their size.
inline int component_type_of(cpca::WeightFormat format) {
  return format == cpca::WeightFormat::float32  ? TINYGLTF_COMPONENT_TYPE_FLOAT
         : format == cpca::WeightFormat::unorm8 ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE
                                                : TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
}

/// Vectors of all clusters.
inline std::size_t vector_count(const cpca::Encoding& encoding) {
  return encoding.component_counts.empty()
             ? static_cast<std::size_t>(encoding.cluster_count) *
                   static_cast<std::size_t>(encoding.component_count)
             : std::accumulate(encoding.component_counts.begin(), encoding.component_counts.end(),
                               std::size_t{0});
}

/// Of points [first, last), weights without padding; adaptive encodings store them so.
inline std::size_t packed_weight_count(const cpca::Encoding& encoding, std::size_t first,
                                       std::size_t last) {
  std::size_t count = 0;
  for (std::size_t p = first; p < last; ++p) {
    count += static_cast<std::size_t>(
        encoding.component_count_of(static_cast<int>(encoding.cluster_of_point[p])));
  }
  return count;
}

}  // namespace prt::gltf
