// What tests of transfer matrices share.
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "core/random.h"
#include "mesh/frame.h"
#include "sh/hemisphere.h"
#include "transfer/matrix.h"
#include "transfer/scenes.h"

namespace prt::transfer {

constexpr double kPi = std::numbers::pi;
using Kind = sh::HemisphereProjection;

inline signal::TransferSignal bake(const mesh::Scene& scene, const std::string& brdf,
                                   MatrixOptions options) {
  DiffuseStats stats;
  options.brdf = brdf;
  return compute_matrices(scene, options, stats);
}

inline brdf::LobePointer lobe_of(const std::string& text) {
  return brdf::parse_brdf(text)->lobes[0].lobe;
}

/// Exit radiance of a vertex towards a world direction under a light of the signal's bands.
inline double exit_radiance(const signal::TransferSignal& signal, const mesh::TriangleMesh& mesh,
                            std::size_t vertex, std::span<const float> light, const Vec3& towards,
                            int channel = 0) {
  const auto functions = sh::hemisphere_functions(signal.row_count);
  const auto [x, y, z] = mesh::frame_at_vertex(mesh, vertex);
  std::vector<double> basis(256);
  sh::evaluate(sh::band_count_of(functions), double{towards.dot(x)}, double{towards.dot(y)},
               double{towards.dot(z)}, basis);
  const auto n = static_cast<std::size_t>(signal.band_count * signal.band_count);
  const float* values = &signal.values[vertex * static_cast<std::size_t>(signal.dimension()) +
                                       static_cast<std::size_t>(channel) * functions.size() * n];
  double sum = 0;
  for (const int function : functions) {
    for (std::size_t j = 0; j < n; ++j, ++values) {
      sum += basis[static_cast<std::size_t>(function)] * double{*values} * double{light[j]};
    }
  }
  return sum;
}

inline std::vector<float> random_light(int band_count, std::uint64_t seed) {
  Pcg32 random(seed);
  std::vector<float> light(static_cast<std::size_t>(band_count * band_count));
  for (float& value : light) value = 2 * random.uniform() - 1;
  light[0] += 2;
  return light;
}

}  // namespace prt::transfer
