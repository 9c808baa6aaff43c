// Shadow rays of a diffuse transfer bake, answered by bare Embree in each of its modes and by us:
// the same rays (blocks of neighbouring vertices of the model, every direction above their
// horizon), the same threads, the same run.
//
//   bench_ray [model.obj] [rays per vertex]

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <pmmintrin.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "core/random.h"
#include "ray/engine.h"
#include "transfer/diffuse.h"
#include "transfer/directions.h"
#include "transfer/spatial_order.h"

namespace {

using namespace prt;
using ray::Ray;

constexpr std::size_t kVertexBlock = 64;  // as in lib/transfer
constexpr std::size_t kBlockStride = 64;  // every 64th block of vertices is traced
constexpr std::size_t kRaysPerTask = 1 << 14;

mesh::TriangleMesh read_obj(const std::string& path) {
  mesh::TriangleMesh mesh;
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Vec3 p;
      words >> p.x >> p.y >> p.z;
      mesh.positions.push_back(p);
    } else if (kind == "f") {
      for (std::string corner; words >> corner;) {
        mesh.indices.push_back(static_cast<std::uint32_t>(std::stoul(corner)) - 1);
      }
    }
  }
  mesh.normals.assign(mesh.positions.size(), Vec3(0.0f));
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const auto [a, b, c] = mesh.triangle(i);
    const Vec3 normal =
        (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
    for (std::uint32_t k : {a, b, c}) mesh.normals[k] += normal;
  }
  for (Vec3& n : mesh.normals) n.normalize();
  return mesh;
}

/// The same rays in three orders.
struct Rays {
  std::vector<Ray> by_direction;  ///< block by block: a direction, then its vertices
  std::vector<Ray> by_vertex;     ///< a vertex, then its directions (ours)
  std::vector<Ray> shuffled;
};

Rays make_rays(const mesh::TriangleMesh& mesh, std::size_t ray_count) {
  const transfer::Directions directions = transfer::make_directions(2 * ray_count, 1);
  const std::vector<std::uint32_t> order = transfer::spatial_order(mesh.positions);
  Rays rays;
  const auto add = [&](std::vector<Ray>& list, std::uint32_t vertex, std::size_t d) {
    const Vec3 n = mesh.normals[vertex];
    if (n.dot(directions[d]) <= 0.0f) return;
    list.push_back({ray::offset_origin(mesh.positions[vertex], n), 0.0f, directions[d]});
  };
  for (std::size_t first = 0; first < order.size(); first += kVertexBlock * kBlockStride) {
    const std::size_t end = std::min(first + kVertexBlock, order.size());
    for (std::size_t d = 0; d < directions.count(); ++d) {
      for (std::size_t v = first; v < end; ++v) add(rays.by_direction, order[v], d);
    }
    for (std::size_t v = first; v < end; ++v) {
      for (std::size_t d = 0; d < directions.count(); ++d) add(rays.by_vertex, order[v], d);
    }
  }
  rays.shuffled = rays.by_vertex;
  Pcg32 random(1);
  for (std::size_t i = rays.shuffled.size(); i > 1; --i) {
    std::swap(rays.shuffled[i - 1], rays.shuffled[random.below(static_cast<std::uint32_t>(i))]);
  }
  return rays;
}

/// Processor time of all threads of this process: other programs do not disturb it as they do the
/// clock on the wall.
double cpu_seconds() {
  timespec time;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Million rays a second, by processor time and the number of threads, of the best of three passes
/// over all rays, and what it counted as blocked.
struct Rate {
  double mrays = 0.0;
  std::size_t blocked = 0;
};

Rate measure(std::size_t count,
             const std::function<std::size_t(std::size_t begin, std::size_t end)>& trace) {
  Rate rate;
  for (int pass = 0; pass < 3; ++pass) {
    std::vector<std::size_t> blocked(block_count(count, kRaysPerTask));
    const double start = cpu_seconds();
    parallel_for(count, kRaysPerTask, [&](std::size_t begin, std::size_t end) {
      _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
      _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
      blocked[begin / kRaysPerTask] = trace(begin, end);
    });
    const double seconds = (cpu_seconds() - start) / thread_count();
    rate.mrays = std::max(rate.mrays, static_cast<double>(count) / seconds * 1e-6);
    rate.blocked = 0;
    for (std::size_t b : blocked) rate.blocked += b;
  }
  return rate;
}

RTCIntersectContext make_context(bool coherent) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

/// Bare Embree with rays in its own layouts, made before the clock starts.
class BareEmbree {
 public:
  BareEmbree(const mesh::TriangleMesh& mesh, bool robust, RTCBuildQuality quality)
      : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    rtcSetSceneBuildQuality(scene_, quality);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                        sizeof(Vec3), mesh.positions.size()),
                mesh.positions.data(), mesh.positions.size() * sizeof(Vec3));
    std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12,
                                        mesh.triangle_count()),
                mesh.indices.data(), mesh.indices.size() * 4);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~BareEmbree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  BareEmbree(const BareEmbree&) = delete;
  BareEmbree& operator=(const BareEmbree&) = delete;

  Rate single(const std::vector<RTCRay>& rays, bool coherent) const {
    return measure(rays.size(), [&](std::size_t begin, std::size_t end) {
      RTCIntersectContext context = make_context(coherent);
      std::size_t blocked = 0;
      for (std::size_t i = begin; i < end; ++i) {
        RTCRay ray = rays[i];
        rtcOccluded1(scene_, &context, &ray);
        blocked += ray.tfar < 0.0f;
      }
      return blocked;
    });
  }

  Rate stream(const std::vector<RTCRay>& rays, bool coherent) const {
    return measure(rays.size(), [&](std::size_t begin, std::size_t end) {
      constexpr std::size_t kStream = 64;
      RTCIntersectContext context = make_context(coherent);
      RTCRay batch[kStream];
      std::size_t blocked = 0;
      for (std::size_t i = begin; i < end; i += kStream) {
        const std::size_t count = std::min(kStream, end - i);
        std::copy_n(&rays[i], count, batch);
        rtcOccluded1M(scene_, &context, batch, static_cast<unsigned>(count), sizeof(RTCRay));
        for (std::size_t k = 0; k < count; ++k) blocked += batch[k].tfar < 0.0f;
      }
      return blocked;
    });
  }

  template <class Packet, std::size_t kWidth, class Call>
  Rate packets(const std::vector<RTCRay>& rays, bool coherent, const Call& call) const {
    std::vector<Packet> packed(rays.size() / kWidth);
    for (std::size_t i = 0; i < packed.size() * kWidth; ++i) {
      const RTCRay& ray = rays[i];
      Packet& packet = packed[i / kWidth];
      const std::size_t k = i % kWidth;
      packet.org_x[k] = ray.org_x, packet.org_y[k] = ray.org_y, packet.org_z[k] = ray.org_z;
      packet.dir_x[k] = ray.dir_x, packet.dir_y[k] = ray.dir_y, packet.dir_z[k] = ray.dir_z;
      packet.tnear[k] = ray.tnear, packet.tfar[k] = ray.tfar, packet.time[k] = 0.0f;
      packet.mask[k] = ray.mask, packet.id[k] = 0, packet.flags[k] = 0;
    }
    return measure(packed.size() * kWidth, [&](std::size_t begin, std::size_t end) {
      RTCIntersectContext context = make_context(coherent);
      alignas(64) int valid[kWidth];
      std::fill_n(valid, kWidth, -1);
      std::size_t blocked = 0;
      for (std::size_t i = begin / kWidth; i < end / kWidth; ++i) {
        Packet packet = packed[i];
        call(valid, scene_, &context, &packet);
        for (std::size_t k = 0; k < kWidth; ++k) blocked += packet.tfar[k] < 0.0f;
      }
      return blocked;
    });
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

std::vector<RTCRay> embree_rays(const std::vector<Ray>& rays) {
  std::vector<RTCRay> result(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    result[i] = {rays[i].origin.x,
                 rays[i].origin.y,
                 rays[i].origin.z,
                 rays[i].t_near,
                 rays[i].direction.x,
                 rays[i].direction.y,
                 rays[i].direction.z,
                 0.0f,
                 rays[i].t_far,
                 0xffffffffu,
                 0,
                 0};
  }
  return result;
}

void print_row(const std::string& name, const char* order, const Rate& rate, std::size_t count) {
  fmt::print("{:<44} {:<13} {:7.2f}   {:6.3f}%\n", name, order, rate.mrays,
             100.0 * static_cast<double>(rate.blocked) / static_cast<double>(count));
}

/// All modes of one scene build; the fastest rate.
double sweep(const mesh::TriangleMesh& mesh, const Rays& rays, bool robust,
             RTCBuildQuality quality) {
  const BareEmbree embree(mesh, robust, quality);
  const std::string scene = fmt::format("{} {}", robust ? "robust" : "fast",
                                        quality == RTC_BUILD_QUALITY_HIGH ? "high" : "medium");
  double best = 0.0;
  const std::pair<const char*, const std::vector<Ray>*> orders[] = {
      {"by direction", &rays.by_direction},
      {"by vertex", &rays.by_vertex},
      {"shuffled", &rays.shuffled}};
  for (const auto& [order, list] : orders) {
    const std::vector<RTCRay> bare = embree_rays(*list);
    for (bool coherent : {false, true}) {
      if (coherent && list == &rays.shuffled) continue;  // it is not, and takes three times as long
      const auto show = [&](const char* mode, const Rate& rate) {
        best = std::max(best, rate.mrays);
        print_row(fmt::format("Embree {}, {}{}", scene, mode, coherent ? ", coherent" : ""), order,
                  rate, bare.size());
      };
      show("single", embree.single(bare, coherent));
      show("packets of 4", embree.packets<RTCRay4, 4>(bare, coherent, rtcOccluded4));
      show("packets of 8", embree.packets<RTCRay8, 8>(bare, coherent, rtcOccluded8));
      show("packets of 16", embree.packets<RTCRay16, 16>(bare, coherent, rtcOccluded16));
      show("streams of 64", embree.stream(bare, coherent));
    }
  }
  return best;
}

Rate measure_engine(const mesh::TriangleMesh& mesh, const std::vector<Ray>& rays) {
  const auto engine = ray::make_embree_engine({mesh.positions, mesh.indices});
  return measure(rays.size(), [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint8_t> blocked(end - begin);
    engine->occluded({&rays[begin], end - begin}, blocked, ray::Coherence::coherent);
    return static_cast<std::size_t>(std::count(blocked.begin(), blocked.end(), 1));
  });
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

}  // namespace

int main(int argc, char** argv) {
  const std::string path = argc > 1 ? argv[1] : "/usr/share/glmark2/models/bunny.obj";
  const int ray_count = argc > 2 ? std::atoi(argv[2]) : 2048;
  const mesh::TriangleMesh mesh = read_obj(path);
  const Rays rays = make_rays(mesh, static_cast<std::size_t>(ray_count));
  fmt::print("{}: {} vertices, {} triangles; {} rays, {} threads\n\n{:<44} {:<13} {}   {}\n", path,
             mesh.vertex_count(), mesh.triangle_count(), rays.by_vertex.size(), thread_count(), "",
             "order", "Mrays/s", "blocked");
  // Ours between Embree's, so that a machine whose speed drifts treats both alike.
  double robust = 0.0, fast = 0.0, engine = 0.0, bake = 0.0;
  const auto measure_ours = [&] {
    const Rate rate = measure_engine(mesh, rays.by_vertex);
    print_row("prtkit ray::Engine (robust)", "by vertex", rate, rays.by_vertex.size());
    engine = std::max(engine, rate.mrays);
    const double baked = measure_bake(mesh, ray_count);
    fmt::print("{:<44} {:<13} {:7.2f}\n", "prtkit transfer, shadowed, 5 bands", "whole model",
               baked);
    bake = std::max(bake, baked);
  };
  measure_ours();
  for (RTCBuildQuality quality : {RTC_BUILD_QUALITY_MEDIUM, RTC_BUILD_QUALITY_HIGH}) {
    robust = std::max(robust, sweep(mesh, rays, true, quality));
    fast = std::max(fast, sweep(mesh, rays, false, quality));
    measure_ours();
  }
  fmt::print("\n{:<32} {:>16} {:>16}\n", "", "ray::Engine", "transfer");
  for (const auto& [name, best] :
       {std::pair("fastest robust", robust), std::pair("fastest", fast)}) {
    fmt::print("of Embree's {:<20} {:>15.0f}% {:>15.0f}%\n", name, 100.0 * engine / best,
               100.0 * bake / best);
  }
}
