#include "gltf/weight_reader.h"

#include <algorithm>

#include "gltf/accessor.h"
#include "gltf/transfer_format.h"
#include "gltf/transfer_values.h"

namespace prt::gltf {

using cpca::WeightFormat;

namespace {

// Of half floats, whose bits glTF takes for integers.
std::vector<float> read_halves(const Model& model, int index) {
  std::vector<float> values;
  for (const std::uint32_t bits : read_unsigned(model, index)) {
    values.push_back(cpca::weight_from_half(static_cast<std::uint16_t>(bits)));
  }
  return values;
}

}  // namespace

void WeightReader::read(const tinygltf::Primitive& primitive, const tinygltf::Value& extension,
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

// Finite floats, or normalised integers as shares of 1.
std::vector<float> WeightReader::read_values(int index, int type, const std::string& name,
                                             const Where& where) {
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
    reject_transfer(where, name, "normalised weights in conventions 1", "conventions 2");
  }
  check_type(accessor, type, component_type_of(format), cpca::is_normalized(format), name, where);
  std::vector<float> values =
      format == WeightFormat::float16 ? read_halves(model_, index) : read_floats(model_, index);
  check_finite(values, name, where);
  return values;
}

void WeightReader::read_attributes(const tinygltf::Primitive& primitive, std::size_t first_vertex,
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
        reject_transfer(where, name, "a weight of no component", "0 past the last component");
      }
    }
  }
}

void WeightReader::read_packed(const tinygltf::Value& extension, std::size_t first_vertex,
                               const Where& where) {
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
    std::copy_n(from, own, encoding.weights.begin() + static_cast<std::ptrdiff_t>(p * components));
    from += own;
  }
}

}  // namespace prt::gltf
