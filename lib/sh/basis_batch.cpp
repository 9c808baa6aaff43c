#include <algorithm>
#include <array>
#include <cassert>

#include "core/cpu.h"
#include "sh/basis.h"
#include "sh/lanes.h"
#include "sh/recurrence.h"

namespace prt::sh {

namespace {

struct Batch {
  int band_count;
  const float *x, *y, *z;
  std::size_t count;
  float* values;
  std::size_t stride;
};

template <class Lanes>
[[gnu::always_inline]] inline void evaluate_block(int band_count, const float* x, const float* y,
                                                  const float* z, float* values,
                                                  std::size_t stride) {
  evaluate_lanes<float>(
      band_count, load<Lanes>(x), load<Lanes>(y),
      load<Lanes>(z), [&](int i, const Lanes& value) __attribute__((always_inline)) {
        store(values + static_cast<std::size_t>(i) * stride, value);
      });
}

// The last, incomplete block goes through padded copies.
template <class Lanes>
[[gnu::always_inline]] inline void evaluate_all(const Batch& batch) {
  constexpr std::size_t kBlock = kLaneCount<Lanes>;
  std::size_t d = 0;
  for (; d + kBlock <= batch.count; d += kBlock) {
    evaluate_block<Lanes>(batch.band_count, batch.x + d, batch.y + d, batch.z + d, batch.values + d,
                          batch.stride);
  }
  if (d == batch.count) return;
  std::array<float, kBlock> x{}, y{}, z{};
  std::array<float, kBlock * coefficient_count(kMaxBandCount)> values;
  const std::size_t rest = batch.count - d;
  std::copy_n(batch.x + d, rest, x.data());
  std::copy_n(batch.y + d, rest, y.data());
  std::copy_n(batch.z + d, rest, z.data());
  evaluate_block<Lanes>(batch.band_count, x.data(), y.data(), z.data(), values.data(), kBlock);
  const auto value_count = row_size(batch.band_count);
  for (std::size_t i = 0; i < value_count; ++i) {
    std::copy_n(values.data() + i * kBlock, rest, batch.values + i * batch.stride + d);
  }
}

PRTKIT_AVX512 void evaluate_avx512(const Batch& batch) { evaluate_all<Lanes16>(batch); }
PRTKIT_AVX2 void evaluate_avx2(const Batch& batch) { evaluate_all<Lanes8>(batch); }

}  // namespace

void evaluate_batch(int band_count, const float* x, const float* y, const float* z,
                    std::size_t count, float* values, std::size_t stride) {
  assert(band_count >= 0 && band_count <= kMaxBandCount && stride >= count);
  const Batch batch{band_count, x, y, z, count, values, stride};
  kernel_for(simd_level(), evaluate_avx512, evaluate_avx2, evaluate_all<Lanes4>)(batch);
}

}  // namespace prt::sh
