#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <pmmintrin.h>

#include <algorithm>
#include <cassert>

#include "core/error.h"
#include "ray/engine.h"

namespace prt::ray {

namespace {

constexpr std::size_t kWidth = 16;

/// Embree wants denormals flushed on the threads that trace; the caller's mode comes back.
class FlushDenormals {
 public:
  FlushDenormals() : saved_(_mm_getcsr()) {
    _mm_setcsr(saved_ | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON);
  }
  ~FlushDenormals() { _mm_setcsr(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned int saved_;
};

struct DeviceDeleter {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, DeviceDeleter>;
using Scene = std::unique_ptr<RTCSceneTy, SceneDeleter>;

/// Copies into a buffer of Embree's (which pads it for its vector loads).
template <class T>
void copy_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t stride,
                 std::size_t count, const T* data) {
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, stride, count);
  if (!buffer) throw_failed("out of memory for the ray tracer's triangles");
  std::copy_n(data, count * stride / sizeof(T), static_cast<T*>(buffer));
}

void check_device(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE) {
    throw_failed("Embree cannot build the scene", {.found = fmt::format("error {}", int{error})});
  }
}

void load_lane(RTCRay16& packet, std::size_t lane, const Ray& ray) {
  packet.org_x[lane] = ray.origin.x;
  packet.org_y[lane] = ray.origin.y;
  packet.org_z[lane] = ray.origin.z;
  packet.tnear[lane] = ray.t_near;
  packet.dir_x[lane] = ray.direction.x;
  packet.dir_y[lane] = ray.direction.y;
  packet.dir_z[lane] = ray.direction.z;
  packet.time[lane] = 0.0f;
  packet.tfar[lane] = ray.t_far;
  packet.mask[lane] = 0xffffffffu;
  packet.id[lane] = 0;
  packet.flags[lane] = 0;
}

/// Embree marks an occluded ray by tfar = -infinity.
bool is_occluded(const RTCRay16& packet, std::size_t lane) { return packet.tfar[lane] < 0.0f; }

Hit hit_of_lane(const RTCRayHit16& packet, std::size_t lane) {
  if (packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) return {};
  const float facing = packet.hit.Ng_x[lane] * packet.ray.dir_x[lane] +
                       packet.hit.Ng_y[lane] * packet.ray.dir_y[lane] +
                       packet.hit.Ng_z[lane] * packet.ray.dir_z[lane];
  return {packet.hit.primID[lane], packet.ray.tfar[lane], packet.hit.u[lane], packet.hit.v[lane],
          facing > 0.0f};
}

class EmbreeEngine final : public Engine {
 public:
  explicit EmbreeEngine(const Triangles& triangles)
      : device_(rtcNewDevice(nullptr)), scene_(device_ ? rtcNewScene(device_.get()) : nullptr) {
    if (!scene_) throw_failed("Embree cannot start");
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_MEDIUM);
    if (!triangles.indices.empty()) add_geometry(triangles);
    rtcCommitScene(scene_.get());
    check_device(device_.get());
  }

  void closest_hit(std::span<const Ray> rays, std::span<Hit> hits) const override {
    assert(hits.size() == rays.size());
    RTCRayHit16 packet;
    for_each_packet(
        packet, rays.size(),
        [&](std::size_t lane, std::size_t i) {
          load_lane(packet.ray, lane, rays[i]);
          packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        },
        rtcIntersect16,
        [&](std::size_t lane, std::size_t i) { hits[i] = hit_of_lane(packet, lane); });
  }

  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded) const override {
    assert(occluded.size() == rays.size());
    RTCRay16 packet;
    for_each_packet(
        packet, rays.size(),
        [&](std::size_t lane, std::size_t i) { load_lane(packet, lane, rays[i]); }, rtcOccluded16,
        [&](std::size_t lane, std::size_t i) { occluded[i] = is_occluded(packet, lane); });
  }

 private:
  /// Rays 16 by 16: load(lane, ray number) into the packet, Embree's call, store(lane, ray number).
  /// Lanes past the end repeat the last ray and are switched off.
  template <class Packet, class Load, class Call, class Store>
  void for_each_packet(Packet& packet, std::size_t count, const Load& load, Call call,
                       const Store& store) const {
    const FlushDenormals flush;
    // Embree's flag for coherent rays is left out: it costs a fifth even for neighbouring
    // directions from one origin (bench/ray.cpp).
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    alignas(64) int valid[kWidth];
    for (std::size_t first = 0; first < count; first += kWidth) {
      const std::size_t used = std::min(kWidth, count - first);
      for (std::size_t lane = 0; lane < kWidth; ++lane) {
        valid[lane] = lane < used ? -1 : 0;
        load(lane, first + std::min(lane, used - 1));
      }
      call(valid, scene_.get(), &context, &packet);
      for (std::size_t lane = 0; lane < used; ++lane) store(lane, first + lane);
    }
  }

  void add_geometry(const Triangles& triangles) {
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    const std::unique_ptr<RTCGeometryTy, void (*)(RTCGeometry)> owner(geometry, rtcReleaseGeometry);
    copy_buffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, sizeof(Vec3),
                triangles.positions.size(), triangles.positions.data());
    copy_buffer(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t),
                triangles.indices.size() / 3, triangles.indices.data());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
  }

  Device device_;
  Scene scene_;
};

}  // namespace

std::string embree_version() {
  const Device device(rtcNewDevice(nullptr));
  const auto number = [&](RTCDeviceProperty property) {
    return rtcGetDeviceProperty(device.get(), property);
  };
  return fmt::format("{}.{}.{}", number(RTC_DEVICE_PROPERTY_VERSION_MAJOR),
                     number(RTC_DEVICE_PROPERTY_VERSION_MINOR),
                     number(RTC_DEVICE_PROPERTY_VERSION_PATCH));
}

std::unique_ptr<Engine> make_embree_engine(const Triangles& triangles) {
  check_triangles(triangles);
  return std::make_unique<EmbreeEngine>(triangles);
}

}  // namespace prt::ray
