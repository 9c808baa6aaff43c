// The formulas of the shaders on the CPU: tests hold rendered pixels against these, and pictures
// that no shader has developed (the path tracer's) are developed by them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/vec.h"
#include "gltf/precomputed_transfer.h"
#include "sh/light.h"
#include "signal/transfer_signal.h"

namespace prt::runtime {

/// Exit values of a vertex from compressed transfer [Sloan03] §6, term by term: for diffuse
/// transfer its radiance, for glossy transfer M_p l, coefficients of exit radiance in the vertex's
/// frame; an RGB for each exit row. Light and transfer have the same number of bands. Twin of
/// transfer_single.vert and transfer_cluster.vert.
std::vector<Vec3> exit_values(const gltf::PrecomputedTransfer& transfer, std::size_t vertex,
                              const sh::Light& light);
/// The same from uncompressed transfer [Sloan02]. Twin of transfer_uncompressed.vert and
/// transfer_matrix.vert.
std::vector<Vec3> exit_values(const signal::TransferSignal& signal, std::size_t vertex,
                              const sh::Light& light);

/// Radiance of exit values towards a unit direction of the vertex's frame, below the horizon that
/// of the horizon there: M_p l · y(v). The functions are evaluated, not looked up. Twin of
/// exit_radiance.frag.
Vec3 exit_radiance(std::span<const Vec3> exit_values, const Vec3& view);

/// The Khronos PBR Neutral tone mapper (Khronos, 2024): hue and base colours as lit up to 0.76,
/// highlights compressed above. Negative radiance, which ringing light has, is black here and
/// nowhere before. Display-linear in [0, 1]. Twin of tone_map.glsl.
Vec3 tone_map(const Vec3& radiance);

}  // namespace prt::runtime
