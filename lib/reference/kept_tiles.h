// The tiles of a picture, and those that a checkpoint (core/checkpoint.h) has.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/checkpoint.h"
#include "reference/path_tracer.h"

namespace prt::reference {

/// All that decides the picture.
std::string checkpoint_key(const mesh::Scene& scene, const camera::Camera& camera,
                           const Options& options, int sample_count);

class KeptTiles {
 public:
  /// Of the images of `result`, which must outlive this.
  KeptTiles(Result& result, const CheckpointOptions& options, const std::string& key);

  std::size_t count() const;
  /// First pixel of a tile.
  Imath::V2i corner(std::size_t tile) const;

  /// Fills in the tiles of an earlier run, sets resumed_share and logs it. Returns for each tile
  /// whether it was there.
  std::vector<std::uint8_t> restore();
  /// Keeps a finished tile; threads may call this.
  void store(std::size_t tile);

 private:
  /// body(first float, number of floats) for each row of the tile in both images.
  template <class Body>
  void for_each_row(std::size_t tile, const Body& body);
  bool restore(std::size_t tile);

  Result& result_;
  Checkpoint checkpoint_;
};

}  // namespace prt::reference
