// What prt-compress reads.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "compress/job.h"
#include "compress/signal.h"
#include "core/report.h"
#include "gltf/document.h"
#include "mesh/scene.h"
#include "sh/radiance_metric.h"
#include "signal/transfer_signal.h"

namespace prt::compress {

struct Input {
  std::optional<gltf::Document> document;
  mesh::Scene scene;                ///< without a document empty
  signal::TransferSignal transfer;  ///< of a plain signal only the values
  std::size_t dimension = 0;
  std::vector<float> coefficient_weights, point_weights;
  std::optional<sh::RadianceMetric> metric;  ///< of matrices, unless coefficients have weights

  Weights weights() const {
    return {point_weights, coefficient_weights, metric ? &*metric : nullptr};
  }
};

/// Reads and checks the files of a job: stage "load" of the report, with hashes. Throws Error.
Input load(const Job& job, Report& report);

}  // namespace prt::compress
