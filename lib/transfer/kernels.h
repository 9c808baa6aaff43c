// Inner loops over coefficient rows, compiled for each level of core/cpu.h. Rows are padded to a
// multiple of kRowPadding floats.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace prt::transfer {

constexpr std::size_t kRowPadding = 8;

constexpr std::size_t padded(std::size_t count) {
  return (count + kRowPadding - 1) / kRowPadding * kRowPadding;
}

/// One row of a sum: `weight` times row number `row`.
struct WeightedRow {
  std::uint32_t row;
  float weight;
};

/// sum[j] += Σ_k terms[k].weight · rows[terms[k].row · stride + j] for j < stride, in order of k.
/// stride is a multiple of kRowPadding.
void add_weighted_rows(std::span<const WeightedRow> terms, const float* rows, std::size_t stride,
                       float* sum);

/// One hit on a triangle: the reflected share of channel c is weights[c] times the field
/// interpolated over its corners.
struct GatherTerm {
  std::uint32_t corners[3];
  float barycentric[3];
  float weights[3];
};

/// sum[c · columns + j] += Σ_k weights[c] · Σ_i barycentric[i] · field[corners[i] · stride +
/// c · columns + j] for c < channels, j < columns; stride = channels · columns.
void add_gathered(std::span<const GatherTerm> terms, const float* field, std::size_t channels,
                  std::size_t columns, float* sum);

}  // namespace prt::transfer
