#include "reference/kept_tiles.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/hash.h"
#include "core/log.h"
#include "reference/tile.h"

namespace prt::reference {

namespace {

std::size_t tiles_along(int pixels) {
  return static_cast<std::size_t>((pixels + kTileSize - 1) / kTileSize);
}

Checkpoint::Name name_of(std::size_t tile) { return {0, static_cast<std::uint32_t>(tile)}; }

}  // namespace

std::string checkpoint_key(const mesh::Scene& scene, const camera::Camera& camera, const Options& o,
                           int sample_count) {
  Hasher view;
  view.add(&camera, sizeof camera);
  return fmt::format("reference {} {} {} {} {} {} {} {} {} {} {}", mesh::scene_hash(scene),
                     view.hex(), o.illumination_key, o.brdf, o.width, o.height, sample_count,
                     o.bounce_count, o.seed, static_cast<int>(o.filter), o.background);
}

KeptTiles::KeptTiles(Result& result, const CheckpointOptions& options, const std::string& key)
    : result_(result), checkpoint_(options, key) {}

std::size_t KeptTiles::count() const {
  return tiles_along(result_.radiance.width) * tiles_along(result_.radiance.height);
}

Imath::V2i KeptTiles::corner(std::size_t tile) const {
  const std::size_t columns = tiles_along(result_.radiance.width);
  return Imath::V2i(static_cast<int>(tile % columns), static_cast<int>(tile / columns)) * kTileSize;
}

template <class Body>
void KeptTiles::for_each_row(std::size_t tile, const Body& body) {
  const Imath::V2i first = corner(tile);
  for (image::Image* image : {&result_.radiance, &result_.standard_error}) {
    const int width = std::min(kTileSize, image->width - first.x);
    for (int y = first.y; y < std::min(first.y + kTileSize, image->height); ++y) {
      body(image->at(first.x, y), static_cast<std::size_t>(width * image->channel_count));
    }
  }
}

std::vector<std::uint8_t> KeptTiles::restore() {
  std::vector<std::uint8_t> restored;
  for (std::size_t tile = 0; tile < count(); ++tile) restored.push_back(restore(tile));
  result_.resumed_share =
      static_cast<double>(std::ranges::count(restored, 1)) / static_cast<double>(restored.size());
  if (result_.resumed_share > 0.0) {
    log::info("continuing an interrupted run, which traced {:.0f}% of the picture",
              100.0 * result_.resumed_share);
  }
  return restored;
}

bool KeptTiles::restore(std::size_t tile) {
  std::size_t size = 0;
  for_each_row(tile, [&](const float*, std::size_t row_size) { size += row_size; });
  std::vector<float> pixels(size);
  if (!checkpoint_.restore(name_of(tile), std::span(pixels))) return false;
  const float* from = pixels.data();
  for_each_row(tile, [&](float* row, std::size_t row_size) {
    std::copy_n(from, row_size, row);
    from += row_size;
  });
  return true;
}

void KeptTiles::store(std::size_t tile) {
  std::vector<float> pixels;
  for_each_row(tile, [&](const float* row, std::size_t row_size) {
    pixels.insert(pixels.end(), row, row + row_size);
  });
  checkpoint_.store(name_of(tile), std::span<const float>(pixels));
}

}  // namespace prt::reference
