#include "transfer/figures.h"

#include "core/log.h"

namespace prt::transfer {

void report_figures(Report& report, const DiffuseStats& stats,
                    const signal::TransferSignal& signal) {
  nlohmann::ordered_json& json = report.json();
  json["vertex_count"] = signal.vertex_count();
  json["channel_count"] = signal.channel_count;
  json["resumed_vertex_count"] = stats.resumed_vertex_count;
  json["resumed_bounce_share"] = stats.resumed_bounce_share;
  json["rays_cast"] = stats.rays_cast;
  json["rays_per_second"] = stats.rays_per_second;
  json["buried_vertex_count"] = stats.buried_vertex_count;
  json["unrepaired_vertex_count"] = stats.unrepaired_vertex_count;
  for (const DiffuseStats::Primitive& primitive : stats.primitives) {
    json["meshes"].push_back({{"name", primitive.name},
                              {"vertex_count", primitive.vertex_count},
                              {"triangle_count", primitive.triangle_count},
                              {"buried_vertex_count", primitive.buried_vertex_count}});
  }
  report.add_stage("build", stats.build_seconds);
  report.add_stage("trace", stats.trace_seconds);
  report.add_stage("bounce", stats.bounce_seconds);
  if (stats.matrix_seconds > 0) report.add_stage("matrices", stats.matrix_seconds);
  if (stats.buried_vertex_count > 0) {
    log::warning("{} of {} vertices are buried in other geometry; {} took their neighbours' values",
                 stats.buried_vertex_count, signal.vertex_count(),
                 stats.buried_vertex_count - stats.unrepaired_vertex_count);
  }
  log::info("{} vertices, {:.1f} million rays, {:.1f} million a second", signal.vertex_count(),
            1e-6 * static_cast<double>(stats.rays_cast), 1e-6 * stats.rays_per_second);
}

}  // namespace prt::transfer
