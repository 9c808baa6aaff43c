// Weights of the coefficients and points of a signal.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "cpca/encoding.h"
#include "mesh/scene.h"

namespace prt::compress {

/// A third of the triangles around each vertex, over the mean of all vertices: 1 on average. Throws
/// Error (bad_input) for a scene without area.
std::vector<float> vertex_areas(const mesh::Scene& scene);

/// Roots of the weights in a .npy file of `dimension` numbers, all > 0. Throws Error (bad_input).
std::vector<float> read_coefficient_scales(const std::filesystem::path& path, std::size_t dimension,
                                           std::size_t max_bytes);

/// Multiplies every row of a signal by the scales, or divides it.
void scale_rows(std::span<const float> scales, std::span<float> rows);
void unscale_rows(std::span<const float> scales, std::span<float> rows);

}  // namespace prt::compress
