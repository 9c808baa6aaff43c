#include "cpca/overdraw.h"

namespace prt::cpca {

std::size_t sent_triangle_count(std::span<const std::uint32_t> indices,
                                std::span<const std::uint32_t> label_of_point) {
  std::size_t count = 0;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    for_each_label(label_of_point[indices[i]], label_of_point[indices[i + 1]],
                   label_of_point[indices[i + 2]], [&](std::uint32_t) { ++count; });
  }
  return count;
}

double overdraw(std::size_t sent_count, std::size_t triangle_count) {
  return triangle_count == 0
             ? 1.0
             : static_cast<double>(sent_count) / static_cast<double>(triangle_count);
}

}  // namespace prt::cpca
