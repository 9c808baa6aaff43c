#include "runtime/cluster_constants.h"

#include <algorithm>
#include <span>
#include <utility>

#include "core/cpu.h"
#include "core/parallel.h"
#include "sh/lanes.h"

namespace prt::runtime {

namespace {

using Lanes = sh::Lanes16;
constexpr std::size_t kLaneCount = sh::kLaneCount<Lanes>;

/// Columns times light: what multiply() needs to know.
struct Product {
  const float* blocks;
  std::size_t channel_count, coefficient_count, column_count;
  const sh::Light& light;
  float* sums;
};

/// Blocks of columns [begin, end): one block's sums stay in registers while its coefficients, which
/// lie side by side in memory, stream by.
[[gnu::always_inline]] inline void multiply(const Product& product, std::size_t begin,
                                            std::size_t end) {
  const std::size_t channel_size = product.coefficient_count * kLaneCount;
  for (std::size_t block = begin; block < end; ++block)
    for (std::size_t color = 0; color < 3; ++color) {
      const std::size_t channel = product.channel_count == 3 ? color : 0;
      const float* t = product.blocks + (block * product.channel_count + channel) * channel_size;
      Lanes sum{};
      for (const float l : product.light.coefficients[color]) {
        sum += l * sh::load<Lanes>(t);
        t += kLaneCount;
      }
      sh::store(product.sums + color * product.column_count + block * kLaneCount, sum);
    }
}

PRTKIT_AVX512 void multiply_avx512(const Product& product, std::size_t begin, std::size_t end) {
  multiply(product, begin, end);
}
PRTKIT_AVX2 void multiply_avx2(const Product& product, std::size_t begin, std::size_t end) {
  multiply(product, begin, end);
}

void multiply_simd(const Product& product, std::size_t begin, std::size_t end) {
  switch (simd_level()) {
    case SimdLevel::avx512:
      return multiply_avx512(product, begin, end);
    case SimdLevel::avx2:
      return multiply_avx2(product, begin, end);
    default:
      return multiply(product, begin, end);
  }
}

}  // namespace

std::vector<std::uint32_t> first_constants(const cpca::Encoding& encoding) {
  std::vector<std::uint32_t> first{0};
  for (int k = 0; k < encoding.cluster_count; ++k)
    first.push_back(first.back() + static_cast<std::uint32_t>(encoding.component_count_of(k)) + 1);
  return first;
}

ClusterConstants::ClusterConstants(const gltf::PrecomputedTransfer& transfer, ExitLayout layout)
    : layout_(std::move(layout)),
      band_count_(transfer.band_count),
      channel_count_(transfer.channel_count) {
  const cpca::Encoding& encoding = transfer.encoding;
  const std::vector<std::uint32_t> first = first_constants(encoding);
  const std::size_t slots = layout_.is_glossy() ? layout_.slot_count() : 1;
  constant_count_ = first.back();
  column_count_ = (constant_count_ * slots + kLaneCount - 1) / kLaneCount * kLaneCount;
  const auto channels = static_cast<std::size_t>(channel_count_);
  const auto rows = static_cast<std::size_t>(transfer.row_count);
  const auto coefficients = static_cast<std::size_t>(band_count_ * band_count_);
  blocks_.resize(column_count_ * channels * coefficients, 0.0f);
  sums_.resize(3 * column_count_);
  constants_.resize(
      constant_count_ * static_cast<std::size_t>(layout_.pass_count) * layout_.pass_vector_count(),
      Vec4(0.0f));
  const auto copy = [&](std::span<const float> source, std::size_t constant) {
    for (std::size_t slot = 0; slot < layout_.row_of_slot.size(); ++slot) {
      const std::size_t column = constant * slots + slot;
      const auto row = static_cast<std::size_t>(layout_.row_of_slot[slot]);
      for (std::size_t c = 0; c < channels; ++c)
        for (std::size_t k = 0; k < coefficients; ++k)
          blocks_[((column / kLaneCount * channels + c) * coefficients + k) * kLaneCount +
                  column % kLaneCount] = source[(c * rows + row) * coefficients + k];
    }
  };
  for (int cluster = 0; cluster < encoding.cluster_count; ++cluster) {
    std::size_t constant = first[static_cast<std::size_t>(cluster)];
    copy(encoding.mean(cluster), constant);
    for (int i = 0; i < encoding.component_count_of(cluster); ++i)
      copy(encoding.basis(cluster, i), ++constant);
  }
}

const std::vector<Vec4>& ClusterConstants::evaluate(const sh::Light& light) {
  constexpr std::size_t kParallelBlock = 256;  // more than diffuse transfer usually has
  const sh::Light fitted = sh::with_band_count(light, band_count_);
  const Product product{blocks_.data(),
                        static_cast<std::size_t>(channel_count_),
                        static_cast<std::size_t>(band_count_ * band_count_),
                        column_count_,
                        fitted,
                        sums_.data()};
  parallel_for(column_count_ / kLaneCount, kParallelBlock,
               [&](std::size_t begin, std::size_t end) { multiply_simd(product, begin, end); });
  place_sums();
  return constants_;
}

void ClusterConstants::place_sums() {
  if (!layout_.is_glossy()) {
    const float* const sums = sums_.data();
    for (std::size_t i = 0; i < constant_count_; ++i)
      constants_[i] = Vec4(sums[i], sums[column_count_ + i], sums[2 * column_count_ + i], 0.0f);
    return;
  }
  const std::size_t vectors = layout_.color_vector_count();
  for (std::size_t color = 0; color < 3; ++color) {
    // With one pass, the colours of a constant follow each other; else the constants of a colour.
    const bool one_pass = layout_.pass_count == 1;
    const std::size_t stride = one_pass ? 3 * vectors : vectors;
    Vec4* to = &constants_[one_pass ? color * vectors : color * constant_count_ * vectors];
    const float* from = &sums_[color * column_count_];
    for (std::size_t i = 0; i < constant_count_; ++i, to += stride, from += 4 * vectors)
      std::copy_n(from, 4 * vectors, &to->x);
  }
}

}  // namespace prt::runtime
