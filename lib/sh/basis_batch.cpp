#include <array>
#include <cassert>
#include <utility>

#include "core/cpu.h"
#include "sh/basis.h"
#include "sh/lanes.h"
#include "sh/recurrence.h"

namespace prt::sh {

namespace {

struct Batch {
  const float *x, *y, *z;
  std::size_t count;
  float* values;
  std::size_t stride;
};

template <int kBands>
[[gnu::always_inline]] inline void evaluate_block(const float* x, const float* y, const float* z,
                                                  float* values, std::size_t stride) {
  evaluate_lanes<float>(kBands, load(x), load(y), load(z), [&](int i, const Lanes& value) {
    store(values + static_cast<std::size_t>(i) * stride, value);
  });
}

// The last, incomplete block goes through padded copies.
template <int kBands>
[[gnu::always_inline]] inline void evaluate_all(const Batch& batch) {
  std::size_t d = 0;
  for (; d + kLaneCount <= batch.count; d += kLaneCount) {
    evaluate_block<kBands>(batch.x + d, batch.y + d, batch.z + d, batch.values + d, batch.stride);
  }
  if (d == batch.count) return;
  std::array<float, kLaneCount> x{}, y{}, z{};
  std::array<float, kLaneCount * coefficient_count(kBands)> values;
  const std::size_t rest = batch.count - d;
  std::copy_n(batch.x + d, rest, x.data());
  std::copy_n(batch.y + d, rest, y.data());
  std::copy_n(batch.z + d, rest, z.data());
  evaluate_block<kBands>(x.data(), y.data(), z.data(), values.data(), kLaneCount);
  for (std::size_t i = 0; i < coefficient_count(kBands); ++i) {
    std::copy_n(values.data() + i * kLaneCount, rest, batch.values + i * batch.stride + d);
  }
}

template <int kBands>
PRTKIT_AVX512 void evaluate_avx512(const Batch& batch) {
  evaluate_all<kBands>(batch);
}
template <int kBands>
PRTKIT_AVX2 void evaluate_avx2(const Batch& batch) {
  evaluate_all<kBands>(batch);
}
template <int kBands>
void evaluate_baseline(const Batch& batch) {
  evaluate_all<kBands>(batch);
}

using Kernel = void (*)(const Batch&);
using KernelTable = std::array<Kernel, kMaxBandCount>;  // [band_count - 1]

template <int... kIndices>
KernelTable kernels_of(SimdLevel level, std::integer_sequence<int, kIndices...>) {
  switch (level) {
    case SimdLevel::avx512:
      return {evaluate_avx512<kIndices + 1>...};
    case SimdLevel::avx2:
      return {evaluate_avx2<kIndices + 1>...};
    default:
      return {evaluate_baseline<kIndices + 1>...};
  }
}

}  // namespace

void evaluate_batch(int band_count, const float* x, const float* y, const float* z,
                    std::size_t count, float* values, std::size_t stride) {
  assert(band_count >= 1 && band_count <= kMaxBandCount && stride >= count);
  static const KernelTable kernels =
      kernels_of(simd_level(), std::make_integer_sequence<int, kMaxBandCount>{});
  kernels[static_cast<std::size_t>(band_count - 1)]({x, y, z, count, values, stride});
}

}  // namespace prt::sh
