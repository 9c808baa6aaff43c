// What prt-transfer does: vectors into a file, or matrices as they are made.
#pragma once

#include <filesystem>

#include "core/report.h"
#include "transfer/matrix.h"

namespace prt::transfer {

/// Writes the transfer file and returns the transfer. Adds the stage "save" to the report. Throws
/// what compute_diffuse and signal::write_transfer throw.
signal::TransferSignal bake_diffuse(const mesh::Scene& scene, const DiffuseOptions& options,
                                    const std::filesystem::path& output, bool no_clobber,
                                    DiffuseStats& stats, Report& report);

/// Writes the transfer file and returns its header. Adds the stages "brdf" and "save" and the keys
/// of matrices of docs/tools/prt-transfer.md to the report. Throws what MatrixTransfer and
/// signal::write_transfer throw.
signal::TransferSignal bake_matrices(const mesh::Scene& scene, const MatrixOptions& options,
                                     const std::filesystem::path& output, bool no_clobber,
                                     DiffuseStats& stats, Report& report);

}  // namespace prt::transfer
