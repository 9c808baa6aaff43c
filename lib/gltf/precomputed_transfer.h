// The content of the glTF extension PRTKIT_precomputed_transfer (docs/extensions).
#pragma once

#include <string>

#include "cpca/encoding.h"

namespace prt::gltf {

/// Compressed transfer of all vertices of a file's scene, numbered through as in mesh::Scene. A
/// vector of the encoding is ordered [channel][exit row][source coefficient].
struct PrecomputedTransfer {
  int band_count = 0;
  int row_count = 1;
  int channel_count = 1;
  std::string brdf = "lambert";
  std::string mesh_hash;
  cpca::Encoding encoding;
};

}  // namespace prt::gltf
