// Triangle lists for the tests of coherence.
#pragma once

#include <cstdint>
#include <vector>

namespace prt::cpca {

/// A sheet of columns × rows points, point y columns + x.
inline std::vector<std::uint32_t> grid(std::uint32_t columns, std::uint32_t rows) {
  std::vector<std::uint32_t> indices;
  for (std::uint32_t y = 0; y + 1 < rows; ++y) {
    for (std::uint32_t x = 0; x + 1 < columns; ++x) {
      const std::uint32_t p = y * columns + x, q = p + columns;
      indices.insert(indices.end(), {p, p + 1, q, p + 1, q + 1, q});
    }
  }
  return indices;
}

}  // namespace prt::cpca
