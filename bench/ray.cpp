// Shadow rays of a diffuse transfer bake, answered by bare Embree in its fastest modes and by us:
// the same rays (blocks of neighbouring vertices of the model, every direction above their
// horizon), the same threads, the same run.
//
//   bench_ray [model.obj] [rays per vertex]

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "bare_embree.h"
#include "core/parallel.h"
#include "core/spatial_order.h"
#include "mesh/mesh_file.h"
#include "mesh/normals.h"
#include "ray/engine.h"
#include "ray/shadow_tree.h"
#include "ray/wide_engine.h"
#include "ray_rate.h"
#include "transfer/diffuse.h"
#include "transfer/directions.h"

namespace {

using namespace prt;
using bench::BareEmbree;
using bench::cpu_seconds;
using bench::kRaysPerTask;
using bench::measure;
using bench::Rate;
using ray::Ray;

constexpr std::size_t kVertexBlock = 64;  // as in lib/transfer
constexpr std::size_t kBlockStride = 64;  // every 64th block of vertices is traced
constexpr int kPasses = 3;

/// The first part of a model, with smooth normals.
mesh::TriangleMesh read_model(const std::string& path) {
  mesh::TriangleMesh mesh = mesh::read_mesh_file(path).primitives.at(0).mesh;
  mesh::compute_normals(mesh, 180.0f);
  return mesh;
}

struct Origin {
  Vec3 p, normal;
};

/// The vertices of every kBlockStride-th block of neighbours.
std::vector<Origin> make_origins(const mesh::TriangleMesh& mesh) {
  const auto position = [&](std::size_t i) { return mesh.positions[i]; };
  const MappedArray<std::uint32_t> order =
      spatial_order({mesh.vertex_count(), position}, mesh.vertex_count(), position);
  std::vector<Origin> origins;
  for (std::size_t first = 0; first < order.size(); first += kVertexBlock * kBlockStride) {
    for (std::size_t v = first; v < std::min(first + kVertexBlock, order.size()); ++v) {
      const Vec3 n = mesh.normals[order[v]];
      origins.push_back({ray::offset_origin(mesh.positions[order[v]], n), n});
    }
  }
  return origins;
}

/// Origin after origin, all directions above its horizon.
std::vector<Ray> make_rays(const std::vector<Origin>& origins,
                           const transfer::Directions& directions) {
  std::vector<Ray> rays;
  for (const Origin& from : origins) {
    for (std::size_t d = 0; d < directions.count(); ++d) {
      if (from.normal.dot(directions[d]) > 0.0f) rays.push_back({from.p, 0.0f, directions[d]});
    }
  }
  return rays;
}

Rate measure_engine(const ray::Engine& engine, const std::vector<Ray>& rays) {
  return measure(rays.size(), kRaysPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint8_t> blocked(end - begin);
    engine.occluded({&rays[begin], end - begin}, blocked);
    return static_cast<std::size_t>(std::count(blocked.begin(), blocked.end(), 1));
  });
}

/// Closest hits, and how many rays have one.
Rate measure_hits(const ray::Engine& engine, const std::vector<Ray>& rays) {
  return measure(rays.size(), kRaysPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<ray::Hit> hits(end - begin);
    engine.closest_hit({&rays[begin], end - begin}, hits);
    return static_cast<std::size_t>(std::count_if(
        hits.begin(), hits.end(), [](const ray::Hit& hit) { return hit.triangle != ray::kNoHit; }));
  });
}

/// The same rays, but the shadow tree finds those above the horizon itself.
Rate measure_shadow_tree(const ray::ShadowTree& tree, const std::vector<Origin>& origins,
                         const std::vector<ray::Beam>& beams, std::size_t ray_count) {
  Rate rate = measure(origins.size(), 16, [&](std::size_t begin, std::size_t end) {
    std::vector<ray::BeamLanes> lanes(beams.size());
    std::size_t blocked = 0;
    for (std::size_t i = begin; i < end; ++i) {
      tree.trace(origins[i].p, origins[i].normal, beams, lanes);
      for (const ray::BeamLanes& l : lanes) {
        blocked += static_cast<std::size_t>(std::popcount(l.blocked));
      }
    }
    return blocked;
  });
  rate.mrays *= static_cast<double>(ray_count) / static_cast<double>(origins.size());
  return rate;
}

/// The whole bake: scene and rays made, traced and projected; everything is counted.
double measure_bake(const mesh::TriangleMesh& mesh, int ray_count) {
  mesh::Scene scene;
  scene.primitives.push_back({"model", mesh, -1});
  transfer::DiffuseStats stats;
  const double start = cpu_seconds();
  transfer::compute_diffuse(scene, {.ray_count = ray_count}, stats);
  const double seconds = (cpu_seconds() - start) / thread_count();
  return static_cast<double>(stats.rays_cast) / seconds * 1e-6;
}

struct Mode {
  std::string name;
  std::function<Rate()> run;
  Rate best = {};
};

/// One pass of each mode after the other, several times, so that a machine whose speed drifts
/// treats all alike.
void run_interleaved(std::vector<Mode>& modes) {
  for (int pass = 0; pass < kPasses; ++pass) {
    for (Mode& mode : modes) {
      const Rate rate = mode.run();
      if (rate.mrays > mode.best.mrays) mode.best = rate;
    }
  }
}

/// Modes of one scene. Packets of 4 and other orders of the rays were never the fastest.
void add_modes(const std::string& name, const BareEmbree& embree, const std::vector<RTCRay>& rays,
               std::vector<Mode>& modes) {
  for (const bool coherent : {true, false}) {
    const std::string suffix = coherent ? ", coherent" : ", incoherent";
    modes.push_back({name + ", packets of 16" + suffix, [&, coherent] {
                       return embree.packets<RTCRay16, 16>(rays, coherent, rtcOccluded16);
                     }});
    modes.push_back({name + ", packets of 8" + suffix, [&, coherent] {
                       return embree.packets<RTCRay8, 8>(rays, coherent, rtcOccluded8);
                     }});
    modes.push_back({name + ", streams of 64" + suffix,
                     [&, coherent] { return embree.stream(rays, coherent); }});
  }
  modes.push_back({name + ", single", [&] { return embree.single(rays, false); }});
}

double fastest(const std::vector<Mode>& modes, const std::string& prefix) {
  double best = 0.0;
  for (const Mode& mode : modes) {
    if (mode.name.starts_with(prefix)) best = std::max(best, mode.best.mrays);
  }
  return best;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string path = argc > 1 ? argv[1] : "/usr/share/glmark2/models/bunny.obj";
  const int ray_count = argc > 2 ? std::atoi(argv[2]) : 2048;
  const mesh::TriangleMesh mesh = read_model(path);
  const transfer::Directions directions =
      transfer::make_directions(2 * static_cast<std::size_t>(ray_count), 1);
  const std::vector<Origin> origins = make_origins(mesh);
  const std::vector<Ray> rays = make_rays(origins, directions);
  const std::vector<RTCRay> bare = bench::embree_rays(rays);
  const auto engine = ray::make_embree_engine({mesh.positions, mesh.indices});
  const auto wide_tree = std::make_shared<const ray::WideTree>(
      ray::TriangleSource::of({mesh.positions, mesh.indices}));
  const auto wide = ray::make_wide_engine(wide_tree);
  const ray::ShadowTree tree(wide_tree);
  const BareEmbree robust(mesh, true, RTC_BUILD_QUALITY_MEDIUM);
  const BareEmbree fast(mesh, false, RTC_BUILD_QUALITY_MEDIUM);
  const BareEmbree fast_high(mesh, false, RTC_BUILD_QUALITY_HIGH);
  std::vector<Mode> modes;
  modes.push_back({"prtkit ray::Engine", [&] { return measure_engine(*engine, rays); }});
  modes.push_back({"prtkit ray::ShadowTree", [&] {
                     return measure_shadow_tree(tree, origins, directions.beams, rays.size());
                   }});
  modes.push_back({"prtkit transfer, 5 bands, whole model", [&] {
                     return Rate{measure_bake(mesh, ray_count), 0};
                   }});
  modes.push_back({"prtkit wide engine", [&] { return measure_engine(*wide, rays); }});
  modes.push_back({"prtkit ray::Engine, closest", [&] { return measure_hits(*engine, rays); }});
  modes.push_back({"prtkit wide engine, closest", [&] { return measure_hits(*wide, rays); }});
  add_modes("Embree robust", robust, bare, modes);
  add_modes("Embree fast", fast, bare, modes);
  add_modes("Embree fast, high quality", fast_high, bare, modes);
  fmt::print("{}: {} vertices, {} triangles; {} rays, {} threads\n\n{:<58} Mrays/s   blocked\n",
             path, mesh.vertex_count(), mesh.triangle_count(), rays.size(), thread_count(), "");
  run_interleaved(modes);
  for (const Mode& mode : modes) {
    fmt::print("{:<58} {:7.2f}   {:6.3f}%\n", mode.name, mode.best.mrays,
               100.0 * static_cast<double>(mode.best.blocked) / static_cast<double>(rays.size()));
  }
  fmt::print("\n{:<32} {:>16} {:>16} {:>16}\n", "", "ray::Engine", "ray::ShadowTree", "transfer");
  for (const char* of : {"Embree robust", "Embree"}) {
    const double best = fastest(modes, of);
    fmt::print("of the fastest {:<17} {:>15.0f}% {:>15.0f}% {:>15.0f}%\n", of,
               100.0 * modes[0].best.mrays / best, 100.0 * modes[1].best.mrays / best,
               100.0 * modes[2].best.mrays / best);
  }
}
