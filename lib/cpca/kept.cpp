#include "cpca/kept.h"

namespace prt::cpca {

void archive(Archive& archive, std::vector<Level>& levels) {
  std::size_t count = levels.size();
  archive.value(count);
  levels.resize(count);
  for (Level& level : levels) {
    archive.value(level.component_count);
    archive.array(level.errors);
    archive.value(level.is_whole);
  }
}

void archive(Archive& archive, Encoded& encoded) {
  Encoding& encoding = encoded.encoding;
  archive.value(encoding.point_count);
  archive.value(encoding.dimension);
  archive.value(encoding.cluster_count);
  archive.value(encoding.component_count);
  archive.array(encoding.means);
  archive.array(encoding.bases);
  archive.array(encoding.cluster_of_point);
  archive.array(encoding.component_counts);
  archive.value(encoded.iterations);
  archive.value(encoded.flops);
  cpca::archive(archive, encoded.levels);
}

int iteration_count(const std::vector<Level>& levels) {
  std::size_t count = 0;
  for (const Level& level : levels) count += level.errors.size();
  return static_cast<int>(count);
}

}  // namespace prt::cpca
