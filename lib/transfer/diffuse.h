// Diffuse transfer vectors [Sloan, Kautz, Snyder 2002]: how each vertex of a scene, a Lambertian
// surface, turns distant light (spherical harmonic coefficients) into exit radiance.
//
//   t_v = albedo_v / pi · E_v,   E_v = E⁰_v + E¹_v + … + Eᴮ_v   (irradiance by bounce number)
//   E⁰_v       = ∫ V(v, d) max(0, n_v·d) Y(d) dd
//   E^(b+1)_v  = ∫ (1 - V(v, d)) max(0, n_v·d) albedo(h) / pi · E^b(h) dd,  h what d hits first
//
// The integrals are sums over one set of directions for all vertices (transfer/directions.h), a
// smaller one for what is reflected. What nothing blocks is known in closed form
// (transfer/clamped_cosine.h), so E⁰ is that minus the sum over blocked directions: exact on a
// convex body, and blocked and reflected energy balance exactly (transfer/reflection.h).
//
// Conventions. A direction below the horizon of the shading normal counts nothing. Front and back
// faces block. E at a hit is interpolated over its triangle, the albedo is the hit point's own. The
// back of a face is black, for the irradiance there is unknown, `double_sided` or not: the inside
// of a closed body is not seen, and an open sheet that should reflect on both sides needs both
// modelled. Of a vertex whose hemisphere is buried in other geometry (transfer/buried.h) the values
// come from the nearest vertices along edges that are not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/checkpoint.h"
#include "mesh/scene.h"
#include "signal/transfer_signal.h"
#include "transfer/channels.h"
#include "transfer/scene_index.h"

namespace prt::transfer {

struct DiffuseOptions {
  int band_count = 5;    ///< of the light, 1 to sh::kMaxBandCount
  int ray_count = 2048;  ///< per vertex, over its hemisphere (on average)
  int bounce_count = 0;  ///< of interreflection; needs shadowed
  int bounce_ray_count =
      0;  ///< per vertex, for what is reflected; at most 16384; 0: a quarter of ray_count
  bool shadowed = true;  ///< false: no rays, the closed form
  ChannelMode channels = ChannelMode::automatic;
  std::uint64_t seed = 1;  ///< turns the set of directions
  /// E⁰ as the closed form minus what is blocked; false: as the sum over what is visible.
  bool closed_form = true;
  std::size_t hit_bytes = std::size_t{320} << 20;    ///< for hits kept between bounces, at most
  std::size_t bounce_bytes = std::size_t{96} << 20;  ///< for the three fields of a bounce in memory
  ScratchOptions scratch{};        ///< what of a large scene lies in files, and where
  CheckpointOptions checkpoint{};  ///< where to keep what is done, for a run that continues it
};

struct DiffuseStats {
  struct Primitive {
    std::string name;
    std::size_t vertex_count = 0;
    std::size_t triangle_count = 0;
    std::size_t buried_vertex_count = 0;
    std::optional<double> interpolation_error{};  ///< transfer/interpolation_error.h; with shadows
    double longest_edge = 0.0;                    ///< metres; with interpolation_error

    /// For transfer at its vertices.
    bool is_coarse() const { return interpolation_error.value_or(0.0) > 0.1; }
  };
  std::vector<Primitive> primitives;
  std::size_t buried_vertex_count = 0;      ///< detected
  std::size_t unrepaired_vertex_count = 0;  ///< of these, connected to no vertex that is not
  std::size_t resumed_vertex_count = 0;     ///< traced by an interrupted run before this one
  double resumed_bounce_share = 0.0;        ///< of the bounces, done by it
  std::uint64_t rays_cast = 0;              ///< occlusion and closest hit, in this run
  double rays_per_second = 0.0;             ///< of the shadow pass
  double build_seconds = 0.0;               ///< the shadow tree, the order of vertices
  double trace_seconds = 0.0;               ///< the shadow pass
  double interpolation_seconds = 0.0;       ///< interpolation_error
  double bounce_seconds = 0.0;              ///< rays of the bounces, and gathering
  double matrix_seconds = 0.0;              ///< matrices without bounces
};

/// Transfer of all vertices of the scene, one exit row. The same bytes for any number of threads.
/// Beyond input and output, memory stays under 500 MB whatever the number of vertices: what else
/// grows with a large scene lies in files (transfer/scene_index.h), some 120 bytes a vertex, and
/// with bounces three times the output; only vertices that are buried take some 300 bytes each.
/// Throws Error (usage) on options out of range, Error (bad_input) on positions or normals that are
/// not finite and Error (failed) when there is no room for files.
signal::TransferSignal compute_diffuse(const mesh::Scene& scene, const DiffuseOptions& options,
                                       DiffuseStats& stats);

}  // namespace prt::transfer
