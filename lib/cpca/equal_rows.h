// Points that are the same: what a search has to know of signals of few different rows, as clusters
// of these are exact.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace prt::cpca {

struct EqualRows {
  std::vector<std::uint32_t> first;   ///< point of each different row
  std::vector<std::uint32_t> labels;  ///< of each point, the number of its row

  int count() const { return static_cast<int>(first.size()); }
};

/// Rows are equal bit by bit. Nothing when more than `most_count` differ, found as soon as they do.
std::optional<EqualRows> find_equal_rows(std::span<const float> signal, std::size_t dimension,
                                         std::size_t most_count);

}  // namespace prt::cpca
