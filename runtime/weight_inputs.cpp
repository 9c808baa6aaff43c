#include "runtime/weight_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/error.h"

namespace prt::runtime {

namespace {

constexpr int kTableUnit = 1;

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

/// Weights that clusters have, point after point in one row of fours; and, two for each point, the
/// number of its first weight and how many they are.
struct PackedWeights {
  std::vector<Vec4> values;
  std::vector<std::uint32_t> ranges;
};

PackedWeights packed_weights(const cpca::Encoding& encoding) {
  PackedWeights packed;
  std::uint32_t count = 0;
  for (std::size_t p = 0; p < encoding.point_count; ++p) {
    const auto own = static_cast<std::uint32_t>(
        encoding.component_count_of(static_cast<int>(encoding.cluster_of_point[p])));
    packed.ranges.insert(packed.ranges.end(), {count, own});
    for (std::uint32_t i = 0; i < own; ++i, ++count) {
      if (count % 4 == 0) packed.values.emplace_back(0.0f);
      packed.values.back()[static_cast<int>(count % 4)] =
          encoding.weights[p * static_cast<std::size_t>(encoding.component_count) + i];
    }
  }
  return packed;
}

}  // namespace

WeightInputs::WeightInputs(const cpca::Encoding& encoding, unsigned int end_location)
    : is_adaptive_(!encoding.component_counts.empty()), component_count_(encoding.component_count) {
  if (is_adaptive_) {
    const PackedWeights packed = packed_weights(encoding);
    weights_ = gl::Buffer(std::span(packed.ranges));
    table_ = gl::Table(packed.values.size());
    table_.upload(packed.values);
    return;
  }
  const int most = 4 * static_cast<int>(end_location - kFirstWeightLocation);
  if (component_count_ > most)
    throw_failed("this OpenGL has too few vertex attributes for the model",
                 {.found = fmt::format("{} components", component_count_),
                  .expected = fmt::format("at most {}", most),
                  .advice = "Compress with fewer components."});
  weights_ = gl::Buffer(std::span<const float>(padded_weights(encoding)));
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
  for (std::size_t i = 0; i < vector_count; ++i)
    array.set_floats(kFirstWeightLocation + static_cast<unsigned int>(i), weights_, 4,
                     vector_count * sizeof(Vec4), i * sizeof(Vec4));
}

void WeightInputs::bind(const gl::Program& program) const {
  if (!is_adaptive_) return;
  program.set("u_weights", kTableUnit);
  table_.bind(kTableUnit);
}

}  // namespace prt::runtime
