#include "transfer/bake.h"

#include "core/log.h"
#include "core/progress.h"
#include "core/stopwatch.h"

namespace prt::transfer {

signal::TransferSignal bake_diffuse(const mesh::Scene& scene, const DiffuseOptions& options,
                                    const std::filesystem::path& output, bool no_clobber,
                                    DiffuseStats& stats, Report& report) {
  signal::TransferSignal signal = compute_diffuse(scene, options, stats);
  const StageTimer timer(report, "save");
  signal::write_transfer(output, signal, no_clobber);
  return signal;
}

signal::TransferSignal bake_matrices(const mesh::Scene& scene, const MatrixOptions& options,
                                     const std::filesystem::path& output, bool no_clobber,
                                     DiffuseStats& stats, Report& report) {
  MatrixTransfer transfer(scene, options, stats);
  report.add_stage("brdf", transfer.surfaces().seconds());
  const auto computing = [&] { return stats.bounce_seconds + stats.matrix_seconds; };
  const double before = computing();
  const Stopwatch watch;
  {
    Progress progress("matrices", transfer.header().vertex_count(), "vertices");
    signal::write_transfer(
        output, transfer.header(),
        [&](auto first, auto count, auto values) {
          transfer.compute(first, count, values);
          progress.advance(count);
        },
        no_clobber);
  }
  report.add_stage("save", watch.seconds() - (computing() - before));
  report.json()["scratch_bytes"] = transfer.scratch_bytes();
  for (const SurfaceLoss& surface : transfer.surfaces().losses()) {
    report.json()["surfaces"].push_back({{"name", surface.name},
                                         {"exit_loss", surface.loss.exit},
                                         {"kernel_loss", surface.loss.kernel},
                                         {"matrix_error", surface.matrix_error}});
    log::info("{}: {:.2f}% of exit radiance and {:.1f}% of the BRDF lie in higher bands",
              surface.name, 100 * surface.loss.exit, 100 * surface.loss.kernel);
  }
  return transfer.header();
}

}  // namespace prt::transfer
