#include "compress/input.h"

#include <unistd.h>

#include "signal/npy.h"

namespace prt::compress {

namespace {

/// What a signal may take: beside it encoders need half as much again.
std::size_t signal_bytes_limit() {
  const auto pages = static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES));
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) / 3 * 2;
}

}  // namespace

Input load(const Job& job, Report& report) {
  const StageTimer timer(report, "load");
  Input input;
  if (job.signal.empty()) {
    input.document = gltf::Document::load(job.model);
    input.scene = input.document->scene();
    input.transfer = signal::read_transfer(job.transfer, signal_bytes_limit());
    signal::check_belongs_to(input.transfer, input.scene, job.transfer);
    input.dimension = static_cast<std::size_t>(input.transfer.dimension());
  } else {
    signal::Matrix matrix = signal::read_npy(job.signal, signal_bytes_limit());
    input.transfer.values = std::move(matrix.values);
    input.dimension = matrix.column_count;
  }
  if (!job.coefficient_weights.empty()) {
    input.coefficient_weights =
        read_coefficient_weights(job.coefficient_weights, input.dimension, signal_bytes_limit());
  } else if (input.transfer.row_count > 1) {
    const auto bands = static_cast<std::size_t>(input.transfer.band_count);
    input.metric.emplace(input.transfer.row_count, bands * bands);
  }
  if (job.weigh_by_area) input.point_weights = vertex_areas(input.scene);
  // Only now, as it reads the files: those that are too large are refused before.
  for (const auto& path : {job.model, job.transfer, job.signal, job.coefficient_weights}) {
    if (!path.empty()) report.add_input(path);
  }
  return input;
}

}  // namespace prt::compress
