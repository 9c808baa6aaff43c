// What prt-transfer --mode matrix does: matrices into a file as they are made.
#pragma once

#include <filesystem>

#include "core/report.h"
#include "transfer/matrix.h"

namespace prt::transfer {

/// Writes the transfer file and returns its header. Adds the stages "brdf" and "save" and the keys
/// of matrices of docs/tools/prt-transfer.md to the report. Throws what MatrixTransfer and
/// signal::write_transfer throw.
signal::TransferSignal bake_matrices(const mesh::Scene& scene, const MatrixOptions& options,
                                     const std::filesystem::path& output, bool no_clobber,
                                     DiffuseStats& stats, Report& report);

}  // namespace prt::transfer
