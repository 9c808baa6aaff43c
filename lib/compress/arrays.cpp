#include "compress/arrays.h"

#include <cstdint>
#include <vector>

#include "signal/npz.h"

namespace prt::compress {

void save_arrays(const std::filesystem::path& path, const cpca::Encoding& encoding,
                 bool no_clobber) {
  const auto points = encoding.point_count, n = static_cast<std::size_t>(encoding.dimension),
             clusters = static_cast<std::size_t>(encoding.cluster_count),
             components = static_cast<std::size_t>(encoding.component_count);
  const bool is_small = clusters <= 65536;
  const std::vector<std::uint16_t> small(
      encoding.cluster_of_point.begin(),
      is_small ? encoding.cluster_of_point.end() : encoding.cluster_of_point.begin());
  std::vector<std::uint32_t> counts = encoding.component_counts;
  if (counts.empty()) counts.assign(clusters, static_cast<std::uint32_t>(components));
  const std::vector<signal::Array> arrays{
      is_small ? signal::make_array("cluster_of_point", "<u2", {points}, small)
               : signal::make_array("cluster_of_point", "<u4", {points}, encoding.cluster_of_point),
      signal::make_array("means", "<f4", {clusters, n}, encoding.means),
      signal::make_array("bases", "<f4", {clusters, components, n}, encoding.bases),
      signal::make_array("weights", "<f4", {points, components}, encoding.weights),
      signal::make_array("component_counts", "<u4", {clusters}, counts)};
  signal::write_npz(path, arrays, no_clobber);
}

}  // namespace prt::compress
