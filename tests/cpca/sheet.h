// A mesh with a signal, for the tests of coherence.
#pragma once

#include <cmath>
#include <set>
#include <vector>

#include "cpca/encoder.h"
#include "cpca/meshes.h"
#include "cpca/signals.h"

namespace prt::cpca {

using Indices = std::vector<std::uint32_t>;

/// Triangles, each as often as its corners have labels.
inline std::size_t plain_sent_count(const Indices& indices, const Indices& labels) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    count += std::set{labels[indices[i]], labels[indices[i + 1]], labels[indices[i + 2]]}.size();
  }
  return count;
}

/// A sheet whose signal varies smoothly in places and jumps in others, as transfer does.
struct Sheet {
  static constexpr std::uint32_t kColumns = 16, kRows = 13;
  static constexpr int kDimension = 12;
  std::vector<float> signal = std::vector<float>(kColumns * kRows * kDimension);
  Indices indices = grid(kColumns, kRows);
  Encoding encoding;

  explicit Sheet(int cluster_count = 14, int component_count = 2) {
    const auto noise = random_values(signal.size(), 5);
    for (std::size_t i = 0; i < signal.size(); ++i) {
      const std::size_t p = i / kDimension;
      const auto x = static_cast<float>(p % kColumns), y = static_cast<float>(p / kColumns);
      const auto k = static_cast<float>(i % kDimension);
      signal[i] = std::sin(0.11f * (k + 1) * x) + std::cos(0.07f * k * y) + (x > y ? 0.4f : 0.0f) +
                  0.3f * noise[i];
    }
    encoding = encode_static(signal, kDimension,
                             {.cluster_count = cluster_count, .component_count = component_count})
                   .encoding;
  }
};

}  // namespace prt::cpca
