#include "transfer/figures.h"

#include <limits>
#include <vector>

#include "core/log.h"

namespace prt::transfer {

namespace {

/// Splitting is for all meshes of a file: as the one that needs it most asks for.
void warn_of_coarse_meshes(const std::vector<DiffuseStats::Primitive>& primitives) {
  constexpr double kPieces = 8.0;  // of the longest edge
  std::size_t coarse_count = 0;
  const DiffuseStats::Primitive* worst = nullptr;
  double length = std::numeric_limits<double>::infinity();
  for (const DiffuseStats::Primitive& primitive : primitives) {
    if (!primitive.is_coarse()) continue;
    ++coarse_count;
    if (!worst || primitive.interpolation_error > worst->interpolation_error) worst = &primitive;
    length = std::min(length, primitive.longest_edge / kPieces);
  }
  if (!worst) return;
  log::warning(
      "too coarse for transfer at vertices: {} of {} meshes; between the vertices of {} irradiance "
      "is off by {:.0f}% (RMS). Split long edges: prt-import --max-edge {:.2g}",
      coarse_count, primitives.size(), worst->name, 100 * *worst->interpolation_error, length);
}

}  // namespace

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
    if (primitive.interpolation_error)
      json["meshes"].back()["interpolation_error"] = *primitive.interpolation_error;
  }
  report.add_stage("build", stats.build_seconds);
  report.add_stage("trace", stats.trace_seconds);
  report.add_stage("interpolation", stats.interpolation_seconds);
  report.add_stage("bounce", stats.bounce_seconds);
  if (stats.matrix_seconds > 0) report.add_stage("matrices", stats.matrix_seconds);
  if (stats.buried_vertex_count > 0) {
    log::warning("{} of {} vertices are buried in other geometry; {} took their neighbours' values",
                 stats.buried_vertex_count, signal.vertex_count(),
                 stats.buried_vertex_count - stats.unrepaired_vertex_count);
  }
  warn_of_coarse_meshes(stats.primitives);
  log::info("{} vertices, {:.1f} million rays, {:.1f} million a second", signal.vertex_count(),
            1e-6 * static_cast<double>(stats.rays_cast), 1e-6 * stats.rays_per_second);
}

}  // namespace prt::transfer
