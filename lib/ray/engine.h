// Batches of rays against a set of triangles: one interface, two engines, Embree's and that of
// large scenes (ray/wide_engine.h). All calls are thread safe, deterministic, and do not allocate;
// a batch runs on the calling thread.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"

namespace prt::ray {

/// What lies in (t_near, t_far] along origin + t direction counts. The direction need not be of
/// unit length; it is finite and not zero, 0 <= t_near <= t_far.
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

/// Coordinates larger than this are refused: Embree silently ignores such triangles.
constexpr float kMaxCoordinate = 1e18f;

/// Triangles of one scene, vertices numbered through. Finite positions and valid indices, checked
/// by what traces them (Embree silently ignores others).
struct Triangles {
  std::span<const Vec3> positions;
  std::span<const std::uint32_t> indices;  ///< three a triangle
};

/// Throws Error (bad_input) unless positions are finite and at most kMaxCoordinate and indices
/// valid.
void check_triangles(const Triangles& triangles);
/// Its parts: one vertex, by its number, and the indices of triangles.
void check_position(const Vec3& position, std::size_t vertex);
void check_indices(std::span<const std::uint32_t> indices, std::size_t vertex_count);

class Engine {
 public:
  virtual ~Engine() = default;
  /// hits.size() == rays.size(). Where nothing is hit, triangle is kNoHit.
  virtual void closest_hit(std::span<const Ray> rays, std::span<Hit> hits) const = 0;
  /// occluded[i] = 1 when anything, front or back, lies in (t_near, t_far], else 0.
  virtual void occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded) const = 0;
};

/// Version of Embree, "3.13.5".
std::string embree_version();

/// Embree 3, robust mode, 16 rays of a batch at a time: fastest when those have about the same
/// origin and direction. Tight along edges; of rays aimed at a vertex to the last bit a few in a
/// thousand pass. Copies what it needs of the triangles.
std::unique_ptr<Engine> make_embree_engine(const Triangles& triangles);

/// A ray origin just off the surface at p on the side of the normal n (of about unit length), far
/// enough that rounding cannot put it on the other side: a step of a few units in the last place of
/// the numbers that p comes from, after [Wächter, Binder 2019, Ray Tracing Gems ch. 6]. `magnitude`
/// is the largest absolute coordinate of those numbers (of the triangles around p) and makes the
/// step right at any scale; the default, of benchmarks and tests, is that paper's, for p near the
/// origin of a scene in metres.
Vec3 offset_origin(const Vec3& p, const Vec3& n, float magnitude = 1.0f / 32.0f);

/// The power of two, which rounds nothing, that brings coordinates up to `largest` into [-2, 2]:
/// so scaled, a scene of any size is traced alike, and no product vanishes or overflows.
float unit_scale(float largest);

}  // namespace prt::ray
