// How far a compressed transfer is from the one it was made of, vertex by vertex; that of matrices
// as exit radiance (sh/radiance_metric.h).
#pragma once

#include <vector>

#include "inspect/inspection.h"

namespace prt::inspect {

struct CompressionError {
  Json json;                     ///< key compression_error of docs/tools/prt-inspect.md
  std::vector<double> relative;  ///< of each vertex: ‖x - x̃‖ / root mean square of ‖x‖
};

/// Throws Error (bad_input) when the model holds no compressed transfer or another mesh's or
/// another shape of transfer.
CompressionError compression_error(const std::filesystem::path& model_path,
                                   const std::filesystem::path& transfer_path);

}  // namespace prt::inspect
