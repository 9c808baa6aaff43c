// Weights of PRTKIT_precomputed_transfer, which lie in attributes of the primitives or, of adaptive
// encodings, packed in accessors of their own.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "gltf/model.h"
#include "gltf/precomputed_transfer.h"

namespace prt::gltf {

/// Weights of one primitive after the other; all of the format that the header tells, or else of
/// that of the first.
class WeightReader {
 public:
  /// Both must outlive this; header and component counts of the transfer are known.
  WeightReader(const Model& model, int conventions, PrecomputedTransfer& transfer)
      : model_(model),
        conventions_(conventions),
        transfer_(transfer),
        known_(transfer.weight_format == cpca::WeightFormat::float16) {}

  /// Those of the vertices from `first_vertex` on, whose clusters are known. Throws Error
  /// (bad_input).
  void read(const tinygltf::Primitive& primitive, const tinygltf::Value& extension,
            std::size_t first_vertex, const Where& where);

 private:
  std::vector<float> read_values(int accessor, int type, const std::string& name,
                                 const Where& where);
  void read_attributes(const tinygltf::Primitive& primitive, std::size_t first_vertex,
                       const Where& where);
  void read_packed(const tinygltf::Value& extension, std::size_t first_vertex, const Where& where);

  const Model& model_;
  int conventions_;
  PrecomputedTransfer& transfer_;
  bool known_;  // whether header or a primitive has told the format
};

}  // namespace prt::gltf
