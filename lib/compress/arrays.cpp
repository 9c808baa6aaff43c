#include "compress/arrays.h"

#include <cstdint>
#include <vector>

#include "signal/npz.h"

namespace prt::compress {

namespace {

constexpr int kMostSmallClusters = 65536;  // with indices of 16 bits

struct Arrays {
  std::vector<std::uint16_t> small_clusters;  ///< in place of the encoding's, where they suffice
  std::vector<std::uint32_t> counts;
  std::vector<float> bases, weights;  ///< without those that clusters do not have
};

Arrays pack(const cpca::Encoding& encoding) {
  const auto n = static_cast<std::size_t>(encoding.dimension),
             components = static_cast<std::size_t>(encoding.component_count);
  Arrays arrays;
  for (int k = 0; k < encoding.cluster_count; ++k) {
    const auto count = static_cast<std::size_t>(encoding.component_count_of(k));
    const auto first = encoding.bases.begin() +
                       static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * components * n);
    arrays.bases.insert(arrays.bases.end(), first, first + static_cast<std::ptrdiff_t>(count * n));
    arrays.counts.push_back(static_cast<std::uint32_t>(count));
  }
  std::size_t count = 0;
  for (const std::uint32_t k : encoding.cluster_of_point) count += arrays.counts[k];
  arrays.weights.reserve(count);
  for (std::size_t p = 0; p < encoding.point_count; ++p) {
    const auto first = encoding.weights.begin() + static_cast<std::ptrdiff_t>(p * components);
    arrays.weights.insert(arrays.weights.end(), first,
                          first + arrays.counts[encoding.cluster_of_point[p]]);
  }
  if (encoding.cluster_count <= kMostSmallClusters) {
    arrays.small_clusters.assign(encoding.cluster_of_point.begin(),
                                 encoding.cluster_of_point.end());
  }
  return arrays;
}

std::vector<signal::Array> list(const Arrays& arrays, const cpca::Encoding& encoding) {
  const auto n = static_cast<std::size_t>(encoding.dimension);
  const std::vector<std::size_t> points{encoding.point_count};
  return {
      encoding.cluster_count <= kMostSmallClusters
          ? signal::make_array("cluster_of_point", "<u2", points, arrays.small_clusters)
          : signal::make_array("cluster_of_point", "<u4", points, encoding.cluster_of_point),
      signal::make_array("component_counts", "<u4", {arrays.counts.size()}, arrays.counts),
      signal::make_array("means", "<f4", {arrays.counts.size(), n}, encoding.means),
      signal::make_array("bases", "<f4", {n == 0 ? 0 : arrays.bases.size() / n, n}, arrays.bases),
      signal::make_array("weights", "<f4", {arrays.weights.size()}, arrays.weights)};
}

}  // namespace

cpca::StorageCost cost_in_arrays(int cluster_count) {
  return {.bytes_of_headers = signal::npz_bytes(list({}, {})),
          .bytes_per_point = cluster_count <= kMostSmallClusters ? 2u : 4u,
          .bytes_per_cluster = sizeof(std::uint32_t)};
}

void save_arrays(const std::filesystem::path& path, const cpca::Encoding& encoding,
                 bool no_clobber) {
  signal::write_npz(path, list(pack(encoding), encoding), no_clobber);
}

}  // namespace prt::compress
