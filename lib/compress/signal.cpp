#include "compress/signal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "signal/npy.h"

namespace prt::compress {

namespace {

constexpr std::size_t kPointBlock = 1024;

}  // namespace

std::vector<float> vertex_areas(const mesh::Scene& scene) {
  std::vector<double> areas(scene.vertex_count());
  double total = 0.0;
  std::size_t first = 0;
  for (const mesh::Primitive& primitive : scene.primitives) {
    const mesh::TriangleMesh& mesh = primitive.mesh;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      const auto [a, b, c] = mesh.triangle(t);
      const Vec3 normal =
          (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
      const double third = double{normal.length()} / 6.0;
      for (const std::uint32_t vertex : {a, b, c}) areas[first + vertex] += third;
      total += 3.0 * third;
    }
    first += mesh.vertex_count();
  }
  if (!(total > 0.0) || !std::isfinite(total)) {
    throw_bad_input("the model has no area that is a number",
                    {.found = fmt::format("{}", total), .advice = "Leave --point-weights out."});
  }
  std::vector<float> weights;
  const double mean = total / static_cast<double>(areas.size());
  for (const double area : areas) weights.push_back(static_cast<float>(area / mean));
  return weights;
}

std::vector<float> read_coefficient_weights(const std::filesystem::path& path,
                                            std::size_t dimension, std::size_t max_bytes) {
  std::vector<float> weights = signal::read_npy(path, max_bytes).values;
  if (weights.size() != dimension) {
    throw_bad_input("another number of coefficient weights",
                    {.file = path.string(),
                     .found = std::to_string(weights.size()),
                     .expected = std::to_string(dimension)});
  }
  const auto bad = std::find_if_not(weights.begin(), weights.end(), [](float w) { return w > 0; });
  if (bad != weights.end()) {
    throw_bad_input("not a weight",
                    {.file = path.string(),
                     .element = fmt::format("coefficient {}", bad - weights.begin()),
                     .found = fmt::format("{}", *bad),
                     .expected = "a number above 0"});
  }
  return weights;
}

double Errors::relative_rmse() const { return energy > 0.0 ? std::sqrt(squared / energy) : 0.0; }

double Errors::relative_max() const {
  return energy > 0.0 ? std::sqrt(largest * static_cast<double>(point_count) / energy) : 0.0;
}

Errors measure(const cpca::Encoding& encoding, std::span<const float> signal,
               const Weights& weights) {
  const auto n = static_cast<std::size_t>(encoding.dimension);
  std::vector<Errors> blocks(block_count(encoding.point_count, kPointBlock));
  parallel_for(encoding.point_count, kPointBlock, [&](std::size_t begin, std::size_t end) {
    std::vector<float> row(n), exact(n);
    Errors& block = blocks[begin / kPointBlock];
    for (std::size_t p = begin; p < end; ++p) {
      cpca::reconstruct(encoding, p, row);
      std::copy_n(&signal[p * n], n, exact.begin());
      if (weights.metric != nullptr) {
        weights.metric->apply(row);
        weights.metric->apply(exact);
      }
      const double point_weight = weights.points.empty() ? 1.0 : double{weights.points[p]};
      double error = 0.0;
      for (std::size_t j = 0; j < n; ++j) {
        const double weight =
            point_weight * (weights.coefficients.empty() ? 1.0 : double{weights.coefficients[j]});
        const double value{exact[j]}, difference = value - double{row[j]};
        error += weight * difference * difference;
        block.energy += weight * value * value;
      }
      block.squared += error;
      block.largest = std::max(block.largest, error);
    }
  });
  Errors errors{.point_count = encoding.point_count};
  for (const Errors& block : blocks) {
    errors.squared += block.squared;
    errors.energy += block.energy;
    errors.largest = std::max(errors.largest, block.largest);
  }
  return errors;
}

}  // namespace prt::compress
