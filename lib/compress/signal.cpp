#include "compress/signal.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "signal/npy.h"

namespace prt::compress {

namespace {

constexpr std::size_t kBlock = 1024;

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

std::vector<float> read_coefficient_scales(const std::filesystem::path& path, std::size_t dimension,
                                           std::size_t max_bytes) {
  std::vector<float> scales = signal::read_npy(path, max_bytes).values;
  if (scales.size() != dimension) {
    throw_bad_input("another number of coefficient weights",
                    {.file = path.string(),
                     .found = std::to_string(scales.size()),
                     .expected = std::to_string(dimension)});
  }
  for (std::size_t i = 0; i < scales.size(); ++i) {
    if (!(scales[i] > 0.0f) || !std::isfinite(scales[i])) {
      throw_bad_input("not a weight", {.file = path.string(),
                                       .element = fmt::format("coefficient {}", i),
                                       .found = fmt::format("{}", scales[i]),
                                       .expected = "a number above 0"});
    }
    scales[i] = std::sqrt(scales[i]);
  }
  return scales;
}

void scale_rows(std::span<const float> scales, std::span<float> rows) {
  parallel_for(rows.size() / scales.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin * scales.size(); i < end * scales.size(); ++i) {
      rows[i] *= scales[i % scales.size()];
    }
  });
}

void unscale_rows(std::span<const float> scales, std::span<float> rows) {
  std::vector<float> inverse;
  for (const float scale : scales) inverse.push_back(1.0f / scale);
  scale_rows(inverse, rows);
}

}  // namespace prt::compress
