#include <algorithm>
#include <array>
#include <cassert>

#include "core/cpu.h"
#include "sh/basis.h"
#include "sh/lanes.h"
#include "sh/rotation.h"

namespace prt::sh {

namespace {

struct Batch {
  int band_count;
  const float* blocks;
  const float* from;
  float* to;
  std::size_t count, stride;
};

// Each band's coefficients stay in registers while its rows pass.
template <class Lanes>
[[gnu::always_inline]] inline void rotate_block(const Batch& batch, const float* from, float* to,
                                                std::size_t stride) {
  const float* entry = batch.blocks;
  for (std::size_t l = 0; l < static_cast<std::size_t>(batch.band_count); ++l) {
    const std::size_t size = 2 * l + 1, first = l * l;
    std::array<Lanes, 2 * kMaxBandCount - 1> band;
    for (std::size_t n = 0; n < size; ++n) band[n] = load<Lanes>(from + (first + n) * stride);
    for (std::size_t m = 0; m < size; ++m) {
      Lanes sum = *entry++ * band[0];
      for (std::size_t n = 1; n < size; ++n) sum += *entry++ * band[n];
      store(to + (first + m) * stride, sum);
    }
  }
}

// The last, incomplete block goes through padded copies.
template <class Lanes>
[[gnu::always_inline]] inline void rotate_all(const Batch& batch) {
  constexpr std::size_t kBlock = kLaneCount<Lanes>;
  std::size_t v = 0;
  for (; v + kBlock <= batch.count; v += kBlock) {
    rotate_block<Lanes>(batch, batch.from + v, batch.to + v, batch.stride);
  }
  if (v == batch.count) return;
  std::array<float, kBlock * coefficient_count(kMaxBandCount)> from{}, to;
  const auto row_count = row_size(batch.band_count);
  for (std::size_t i = 0; i < row_count; ++i) {
    std::copy_n(batch.from + i * batch.stride + v, batch.count - v, from.data() + i * kBlock);
  }
  rotate_block<Lanes>(batch, from.data(), to.data(), kBlock);
  for (std::size_t i = 0; i < row_count; ++i) {
    std::copy_n(to.data() + i * kBlock, batch.count - v, batch.to + i * batch.stride + v);
  }
}

PRTKIT_AVX512 void rotate_avx512(const Batch& batch) { rotate_all<Lanes16>(batch); }
PRTKIT_AVX2 void rotate_avx2(const Batch& batch) { rotate_all<Lanes8>(batch); }

}  // namespace

void Rotation::apply_batch(const float* from, float* to, std::size_t count,
                           std::size_t stride) const {
  assert(stride >= count);
  const Batch batch{band_count_, blocks_float_.data(), from, to, count, stride};
  kernel_for(simd_level(), rotate_avx512, rotate_avx2, rotate_all<Lanes4>)(batch);
}

}  // namespace prt::sh
