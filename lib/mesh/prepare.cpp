#include "mesh/prepare.h"

#include "core/error.h"
#include "core/log.h"
#include "mesh/normals.h"
#include "mesh/tessellate.h"

namespace prt::mesh {

std::vector<std::uint32_t> prepare(TriangleMesh& mesh, const PrepareOptions& options,
                                   RepairReport& report) {
  std::vector<std::uint32_t> source = repair(mesh, options.repair, report);
  if (mesh.triangle_count() == 0) return source;
  if (!mesh.texcoords.empty() && mesh.tangents.empty()) compute_tangents(mesh);
  if (options.max_edge > 0.0f) {
    tessellate(mesh, options.max_edge, options.max_triangles);
    source.clear();
  }
  return source;
}

std::vector<RepairReport> prepare(Scene& scene, const PrepareOptions& options,
                                  const std::string& file) {
  std::vector<RepairReport> reports;
  std::vector<Primitive> kept;
  for (Primitive& primitive : scene.primitives) {
    RepairReport report;
    prepare(primitive.mesh, options, report);
    if (primitive.mesh.triangle_count() == 0) {
      log::warning("{}: mesh {}: nothing left after repair, dropped", file, primitive.name);
      continue;
    }
    primitive.mesh_index = static_cast<int>(kept.size());
    kept.push_back(std::move(primitive));
    reports.push_back(report);
  }
  scene.primitives = std::move(kept);
  if (scene.primitives.empty()) {
    throw_bad_input("empty mesh: no triangle is left after repair", {.file = file});
  }
  return reports;
}

void to_world(Scene& scene, float metres_per_unit, UpAxis up) {
  const auto turned = [&](const Vec3& v) { return up == UpAxis::z ? Vec3(v.x, v.z, -v.y) : v; };
  for (Primitive& primitive : scene.primitives) {
    for (Vec3& p : primitive.mesh.positions) p = turned(p) * metres_per_unit;
    for (Vec3& n : primitive.mesh.normals) n = turned(n);
  }
}

}  // namespace prt::mesh
