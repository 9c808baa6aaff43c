// What prt-compress does: a transfer signal, or one of any origin, through an encoder of clustered
// PCA into the glTF file that it belongs to, or into plain arrays.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/checkpoint.h"
#include "core/report.h"
#include "cpca/encoder.h"
#include "cpca/search.h"
#include "cpca/storage.h"

namespace prt::compress {

struct Job {
  std::filesystem::path model, transfer, output;      ///< both inputs, or `signal` alone
  std::filesystem::path signal;                       ///< .npy, a point a row; output .npz or none
  std::filesystem::path coefficient_weights;          ///< .npy, of squares; empty: 1 each
  bool weigh_by_area = false;                         ///< points by the area around their vertices
  std::string method = "iterative";                   ///< vq, pca, static, iterative, adaptive
  std::optional<int> cluster_count, component_count;  ///< as asked for
  int max_component_count = 0;                        ///< as in cpca::Options
  std::optional<int> iterations;
  std::uint64_t seed = 1;
  cpca::Bound bound;  ///< empty: the counts above
  cpca::StorageOptions storage;
  bool no_clobber = false;
  CheckpointOptions checkpoint{};  ///< where to keep what is done, for a run that continues it
};

/// Throws Error (usage) for what cannot be meant together.
void check(const Job& job);

/// Reads, encodes, reports (docs/tools/prt-compress.md) and writes. Throws Error.
void run(const Job& job, Report& report);

}  // namespace prt::compress
