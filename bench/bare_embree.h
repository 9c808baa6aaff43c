// Embree with nothing between it and the clock.
#pragma once

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "ray/engine.h"
#include "ray_rate.h"

namespace prt::bench {

constexpr std::size_t kRaysPerTask = 1 << 14;

inline std::vector<RTCRay> embree_rays(const std::vector<ray::Ray>& rays) {
  std::vector<RTCRay> result;
  for (const ray::Ray& ray : rays) {
    const Vec3 &o = ray.origin, &d = ray.direction;
    result.push_back(
        {o.x, o.y, o.z, ray.t_near, d.x, d.y, d.z, 0.0f, ray.t_far, 0xffffffffu, 0, 0});
  }
  return result;
}

inline RTCIntersectContext make_context(bool coherent) {
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
    return measure(rays.size(), kRaysPerTask, [&](std::size_t begin, std::size_t end) {
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
    return measure(rays.size(), kRaysPerTask, [&](std::size_t begin, std::size_t end) {
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
    return measure(packed.size() * kWidth, kRaysPerTask, [&](std::size_t begin, std::size_t end) {
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

}  // namespace prt::bench
