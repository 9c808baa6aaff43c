#include "runtime/weight_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/error.h"
#include "gl/context.h"

namespace prt::runtime {

namespace {

constexpr int kTableUnit = 1;

gl::Scalar scalar_of(cpca::WeightFormat format) {
  switch (format) {
    case cpca::WeightFormat::float16:
      return gl::Scalar::float16;
    case cpca::WeightFormat::unorm16:
      return gl::Scalar::unorm16;
    case cpca::WeightFormat::unorm8:
      return gl::Scalar::unorm8;
    default:
      return gl::Scalar::float32;
  }
}

/// Weights in fours, zero padded.
std::vector<float> padded_weights(const cpca::Encoding& encoding) {
  const auto components = static_cast<std::size_t>(encoding.component_count);
  const std::size_t stride = (components + 3) / 4 * 4;
  std::vector<float> padded(encoding.point_count * stride, 0.0f);
  for (std::size_t p = 0; p < encoding.point_count; ++p)
    std::copy_n(encoding.weights.begin() + static_cast<std::ptrdiff_t>(p * components), components,
                padded.begin() + static_cast<std::ptrdiff_t>(p * stride));
  return padded;
}

/// Weights that clusters have, point after point in one row, zero padded to fours; and, two for
/// each point, the number of its first weight and how many they are.
struct PackedWeights {
  std::vector<float> values;
  std::vector<std::uint32_t> ranges;
};

PackedWeights packed_weights(const cpca::Encoding& encoding) {
  PackedWeights packed;
  std::uint32_t count = 0;
  for (std::size_t p = 0; p < encoding.point_count; ++p) {
    const auto own = static_cast<std::uint32_t>(
        encoding.component_count_of(static_cast<int>(encoding.cluster_of_point[p])));
    packed.ranges.insert(packed.ranges.end(), {count, own});
    const float* const weights =
        encoding.weights.data() + p * static_cast<std::size_t>(encoding.component_count);
    packed.values.insert(packed.values.end(), weights, weights + own);
    count += own;
  }
  packed.values.resize((packed.values.size() + 3) / 4 * 4);
  return packed;
}

}  // namespace

WeightInputs::WeightInputs(const cpca::Encoding& encoding, cpca::WeightFormat format,
                           unsigned int end_location)
    : is_adaptive_(!encoding.component_counts.empty()), component_count_(encoding.component_count) {
  if (is_adaptive_ && format == cpca::WeightFormat::unorm16 && !gl::limits().unorm16_textures)
    format = cpca::WeightFormat::float32;
  scalar_ = scalar_of(format);
  scalar_bytes_ = cpca::bytes_of(format);
  if (is_adaptive_) {
    const PackedWeights packed = packed_weights(encoding);
    weights_ = gl::Buffer(std::span(packed.ranges));
    table_ = gl::Table(packed.values.size() / 4, scalar_);
    table_.upload(cpca::stored_weights(format, packed.values));
    return;
  }
  const int most = 4 * static_cast<int>(end_location - kFirstWeightLocation);
  if (component_count_ > most)
    throw_failed("this OpenGL has too few vertex attributes for the model",
                 {.found = fmt::format("{} components", component_count_),
                  .expected = fmt::format("at most {}", most),
                  .advice = "Compress with fewer components."});
  weights_ = gl::Buffer(
      std::span<const std::byte>(cpca::stored_weights(format, padded_weights(encoding))));
}

gl::Defines WeightInputs::defines() const {
  if (is_adaptive_) return {"ADAPTIVE 1"};
  std::string inputs, loop;
  for (int i = 0; i < component_count_; ++i) {
    if (i % 4 == 0)
      inputs += fmt::format("layout(location = {}) in vec4 a_weights_{}; ",
                            kFirstWeightLocation + static_cast<unsigned int>(i) / 4, i / 4);
    loop += fmt::format("F({}, a_weights_{}.{}) ", i, i / 4, "xyzw"[i % 4]);
  }
  return {"WEIGHT_INPUTS " + inputs, "FOR_EACH_WEIGHT(F) " + loop};
}

void WeightInputs::attach(gl::VertexArray& array) const {
  if (is_adaptive_) return array.set_uints(kFirstWeightLocation, weights_, 2);
  const std::size_t vector_count = (static_cast<std::size_t>(component_count_) + 3) / 4;
  const std::size_t vector_bytes = 4 * scalar_bytes_;
  for (std::size_t i = 0; i < vector_count; ++i)
    array.set_floats(kFirstWeightLocation + static_cast<unsigned int>(i), weights_, 4,
                     vector_count * vector_bytes, i * vector_bytes, scalar_);
}

void WeightInputs::bind(const gl::Program& program) const {
  if (!is_adaptive_) return;
  program.set("u_weights", kTableUnit);
  table_.bind(kTableUnit);
}

}  // namespace prt::runtime
