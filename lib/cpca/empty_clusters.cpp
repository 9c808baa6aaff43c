#include "cpca/empty_clusters.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

namespace prt::cpca {

namespace {

/// Of values in rows of `size`, the first `new_size` of each row in `rows`, which rise.
void keep(std::span<const std::size_t> rows, std::size_t size, std::size_t new_size,
          std::vector<float>& values) {
  std::vector<float> kept(rows.size() * new_size);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(rows[i] * size), new_size,
                kept.begin() + static_cast<std::ptrdiff_t>(i * new_size));
  }
  values = std::move(kept);
}

}  // namespace

void drop_empty_clusters(Encoding& encoding) {
  std::vector<std::uint32_t> place(static_cast<std::size_t>(encoding.cluster_count));
  for (const std::uint32_t cluster : encoding.cluster_of_point) place[cluster] = 1;
  std::vector<std::size_t> used;
  for (std::size_t k = 0; k < place.size(); ++k) {
    if (place[k] == 0) continue;
    place[k] = static_cast<std::uint32_t>(used.size());
    used.push_back(k);
  }
  if (used.empty() || used.size() == place.size()) return;

  const auto n = static_cast<std::size_t>(encoding.dimension);
  const auto components = static_cast<std::size_t>(encoding.component_count);
  auto& counts = encoding.component_counts;
  std::size_t most = components;
  if (!counts.empty()) {
    for (std::size_t i = 0; i < used.size(); ++i) counts[i] = counts[used[i]];
    counts.resize(used.size());
    most = *std::max_element(counts.begin(), counts.end());
  }
  keep(used, n, n, encoding.means);
  keep(used, components * n, most * n, encoding.bases);
  if (most < components && !encoding.weights.empty()) {
    std::vector<std::size_t> points(encoding.point_count);
    std::iota(points.begin(), points.end(), std::size_t{0});
    keep(points, components, most, encoding.weights);
  }
  encoding.cluster_count = static_cast<int>(used.size());
  encoding.component_count = static_cast<int>(most);
  for (std::uint32_t& cluster : encoding.cluster_of_point) cluster = place[cluster];
}

}  // namespace prt::cpca
