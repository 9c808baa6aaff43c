// Batches of rays against a set of triangles: one interface, several engines (Embree first). All
// calls are thread safe, deterministic, and do not allocate; a batch runs on the calling thread.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/vec.h"

namespace prt::ray {

struct Ray {
  Vec3 origin;
  float t_near = 0.0f;
  Vec3 direction;
  float t_far = std::numeric_limits<float>::infinity();
};

constexpr std::uint32_t kNoHit = 0xffffffffu;

struct Hit {
  std::uint32_t triangle = kNoHit;  ///< number in the list given to the engine
  float t = 0.0f;
  float u = 0.0f, v = 0.0f;  ///< the point is (1-u-v) p0 + u p1 + v p2
  bool back_face = false;    ///< the ray came from behind (clockwise side)
};

/// What is known about neighbours in a batch: engines are faster on coherent ones.
enum class Coherence { incoherent, coherent };

/// Triangles of one scene, vertices numbered through. Finite positions and valid indices, checked
/// by the engine's maker (Embree silently ignores others), which throws Error (bad_input).
struct Triangles {
  std::span<const Vec3> positions;
  std::span<const std::uint32_t> indices;  ///< three a triangle
};

class Engine {
 public:
  virtual ~Engine() = default;
  /// hits.size() == rays.size().
  virtual void closest_hit(std::span<const Ray> rays, std::span<Hit> hits,
                           Coherence coherence) const = 0;
  /// occluded[i] = 1 when anything, front or back, lies in (t_near, t_far], else 0.
  virtual void occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded,
                        Coherence coherence) const = 0;
};

/// Embree 3, robust mode. Copies what it needs of the triangles.
std::unique_ptr<Engine> make_embree_engine(const Triangles& triangles);

/// A ray origin just off the surface at p on the side of the unit normal n, far enough that
/// rounding cannot put it on the other side [Wächter, Binder 2019, Ray Tracing Gems ch. 6].
Vec3 offset_origin(const Vec3& p, const Vec3& n);

}  // namespace prt::ray
