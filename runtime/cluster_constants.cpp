#include "runtime/cluster_constants.h"

#include <algorithm>
#include <span>

namespace prt::runtime {

std::vector<std::uint32_t> first_constants(const cpca::Encoding& encoding) {
  std::vector<std::uint32_t> first{0};
  for (int k = 0; k < encoding.cluster_count; ++k)
    first.push_back(first.back() + static_cast<std::uint32_t>(encoding.component_count_of(k)) + 1);
  return first;
}

ClusterConstants::ClusterConstants(const gltf::PrecomputedTransfer& transfer)
    : band_count_(transfer.band_count), channel_count_(transfer.channel_count) {
  const cpca::Encoding& encoding = transfer.encoding;
  const auto dimension = static_cast<std::size_t>(encoding.dimension);
  const std::vector<std::uint32_t> first = first_constants(encoding);
  row_count_ = first.back();
  transposed_.resize(row_count_ * dimension);
  sums_.resize(3 * row_count_);
  constants_.resize(row_count_, Vec4(0.0f));
  const auto copy = [&](std::span<const float> source, std::size_t row) {
    for (std::size_t k = 0; k < dimension; ++k) transposed_[k * row_count_ + row] = source[k];
  };
  for (int cluster = 0; cluster < encoding.cluster_count; ++cluster) {
    std::size_t row = first[static_cast<std::size_t>(cluster)];
    copy(encoding.mean(cluster), row);
    for (int i = 0; i < encoding.component_count_of(cluster); ++i)
      copy(encoding.basis(cluster, i), ++row);
  }
}

const std::vector<Vec4>& ClusterConstants::evaluate(const sh::Light& light) {
  // Rows run innermost, so that the compiler vectorises over them without reordering any sum; a
  // block of rows stays in the nearest cache.
  constexpr std::size_t kBlock = 512;
  const auto coefficient_count = static_cast<std::size_t>(band_count_ * band_count_);
  const sh::Light fitted = sh::with_band_count(light, band_count_);
  std::fill(sums_.begin(), sums_.end(), 0.0f);
  for (std::size_t begin = 0; begin < row_count_; begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, row_count_);
    for (std::size_t color = 0; color < 3; ++color) {
      const std::size_t channel = channel_count_ == 3 ? color : 0;
      float* const sum = &sums_[color * row_count_];
      for (std::size_t k = 0; k < coefficient_count; ++k) {
        const float l = fitted.coefficients[color][k];
        const float* const t = &transposed_[(channel * coefficient_count + k) * row_count_];
        for (std::size_t row = begin; row < end; ++row) sum[row] += l * t[row];
      }
    }
  }
  for (std::size_t row = 0; row < row_count_; ++row)
    constants_[row] = Vec4(sums_[row], sums_[row_count_ + row], sums_[2 * row_count_ + row], 0.0f);
  return constants_;
}

}  // namespace prt::runtime
