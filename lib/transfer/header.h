// What the header of every transfer file says of its scene and how it was baked.
#pragma once

#include "mesh/scene.h"
#include "signal/transfer_signal.h"

namespace prt::transfer {

/// A signal without values, of one row and one channel. `options` are DiffuseOptions or
/// MatrixOptions.
template <class Options>
signal::TransferSignal make_header(const mesh::Scene& scene, const Options& options) {
  signal::TransferSignal header;
  header.band_count = options.band_count;
  header.seed = options.seed;
  header.ray_count = options.shadowed ? options.ray_count : 0;
  header.bounce_count = options.bounce_count;
  header.tool_version = PRTKIT_VERSION;
  header.mesh_hash = mesh::mesh_hash(scene);
  for (const mesh::Primitive& primitive : scene.primitives) {
    header.blocks.push_back({primitive.name, primitive.mesh.vertex_count()});
  }
  return header;
}

}  // namespace prt::transfer
