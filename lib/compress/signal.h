// Weights of the coefficients and points of a signal, and errors by them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "cpca/encoding.h"
#include "mesh/scene.h"
#include "sh/radiance_metric.h"

namespace prt::compress {

/// A third of the triangles around each vertex, over the mean of all vertices: 1 on average. Throws
/// Error (bad_input) for a scene without area.
std::vector<float> vertex_areas(const mesh::Scene& scene);

/// The weights in a .npy file of `dimension` numbers, all > 0. Throws Error (bad_input).
std::vector<float> read_coefficient_weights(const std::filesystem::path& path,
                                            std::size_t dimension, std::size_t max_bytes);

/// Of squares: of each point and each coefficient; empty: 1 each. With a metric, of its
/// coordinates.
struct Weights {
  std::span<const float> points = {}, coefficients = {};
  const sh::RadianceMetric* metric = nullptr;

  bool empty() const { return points.empty() && coefficients.empty() && metric == nullptr; }
};

struct Errors {
  double squared = 0.0, energy = 0.0, largest = 0.0;  ///< as cpca::Figures, all weighted
  std::size_t point_count = 0;

  /// By the norms of cpca::Norm; 0 for a signal without energy.
  double relative_rmse() const;
  double relative_max() const;
};

/// Squared errors e_p = w_p Σ_j w_j (x_pj - x̃_pj)² of an encoding as it is, summed in double.
/// Of x and x̃ in the metric's coordinates, where there is one.
Errors measure(const cpca::Encoding& encoding, std::span<const float> signal,
               const Weights& weights);

}  // namespace prt::compress
