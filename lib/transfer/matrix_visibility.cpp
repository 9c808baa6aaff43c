#include "transfer/matrix_visibility.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "core/stopwatch.h"
#include "linalg/product.h"
#include "sh/basis.h"
#include "sh/quadrature.h"
#include "sh/zonal.h"
#include "transfer/buried.h"
#include "transfer/interpolation_error.h"
#include "transfer/reflection.h"
#include "transfer/resume.h"

namespace prt::transfer {

namespace {

class VisibilityPass {
 public:
  VisibilityPass(const SceneIndex& index, const VisibilityOptions& options, Checkpoint& checkpoint,
                 DiffuseStats& stats)
      : index_(index),
        options_(options),
        checkpoint_(checkpoint),
        stats_(stats),
        directions_(make_directions(2 * static_cast<std::size_t>(options.ray_count), options.seed)),
        count_(sh::row_size(options.band_count)),
        lobe_(sh::disk_lobe(options.band_count, std::numbers::pi / 2)),
        rows_(index.vertex_count() * count_, index.scratch_folder()),
        buried_(index.vertex_count(), index.scratch_folder()) {}

  Visibility run() {
    const Stopwatch watch;
    std::vector<float> basis;
    if (options_.shadowed) basis = basis_rows(options_.band_count, directions_);
    const TracedRows traced{rows_.data(), count_, count_, buried_.data()};
    stats_.rays_cast = trace_vertices(
        checkpoint_, index_, traced, "visibility", options_.ray_count,
        [&](std::size_t begin, std::size_t end) { return run_block(begin, end, basis); }, stats_);
    stats_.rays_cast += confirm_buried(index_, directions_, buried_);
    const BuriedRepair repair(index_, buried_);
    repair.apply(rows_.data(), count_);
    fill_stats(repair);
    stats_.trace_seconds = watch.seconds();
    stats_.rays_per_second = static_cast<double>(stats_.rays_cast) / stats_.trace_seconds;
    if (options_.shadowed) measure_interpolation(index_, stats_);
    return {std::move(rows_), repair.stand_ins(index_)};
  }

 private:
  std::uint64_t run_block(std::size_t begin, std::size_t end, const std::vector<float>& basis) {
    Hemisphere hemisphere(index_, directions_);
    std::vector<double> whole(count_);
    std::vector<float> sum(padded(count_));
    std::vector<WeightedRow> blocked;
    const auto weight =
        static_cast<float>(4.0 * std::numbers::pi / static_cast<double>(directions_.count()));
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t vertex = index_.vertex_order()[i];
      sh::turn_lobe(lobe_, index_.normal(vertex), whole);
      float* row = &rows_[vertex * count_];
      std::copy(whole.begin(), whole.end(), row);
      if (!options_.shadowed) continue;
      hemisphere.trace(vertex);
      blocked.assign(hemisphere.blocked().begin(), hemisphere.blocked().end());
      for (WeightedRow& term : blocked) term.weight = weight;
      std::fill(sum.begin(), sum.end(), 0.0f);
      add_weighted_rows(blocked, basis.data(), sum.size(), sum.data());
      for (std::size_t k = 0; k < count_; ++k) row[k] -= sum[k];
      buried_[vertex] = sees_nothing(hemisphere);
    }
    trim_mapped_arrays();
    return hemisphere.rays_cast();
  }

  void fill_stats(const BuriedRepair& repair) {
    std::size_t vertex = 0;
    for (const mesh::Primitive& primitive : index_.scene().primitives) {
      const std::size_t count = primitive.mesh.vertex_count();
      const std::uint8_t* first = buried_.data() + vertex;
      const auto number = static_cast<std::size_t>(std::count(first, first + count, 1));
      stats_.primitives.push_back({primitive.name, count, primitive.mesh.triangle_count(), number});
      stats_.buried_vertex_count += number;
      vertex += count;
    }
    stats_.unrepaired_vertex_count = stats_.buried_vertex_count - repair.repaired_count();
  }

  const SceneIndex& index_;
  const VisibilityOptions& options_;
  Checkpoint& checkpoint_;
  DiffuseStats& stats_;
  const Directions directions_;
  const std::size_t count_;
  const std::vector<double> lobe_;  // the hemisphere about +Z
  MappedArray<float> rows_;
  MappedArray<std::uint8_t> buried_;
};

}  // namespace

Visibility compute_visibility(const SceneIndex& index, const VisibilityOptions& options,
                              Checkpoint& checkpoint, DiffuseStats& stats) {
  return VisibilityPass(index, options, checkpoint, stats).run();
}

// Yᵀ W (Y ∘ Y) over a product rule that is exact for polynomials of degree 4 (n - 1), which a
// triple product is: Gauss in z, equal steps in the azimuth.
std::vector<float> triple_products(int band_count) {
  assert(band_count >= 1 && band_count <= kMaxMatrixBandCount);
  const std::size_t n = sh::row_size(band_count), m = sh::row_size(2 * band_count - 1);
  const sh::GaussLegendre rule(2 * band_count - 1);
  const int step_count = 4 * band_count - 3;
  const std::size_t node_count = rule.nodes.size() * static_cast<std::size_t>(step_count);
  std::vector<double> single(node_count * m), pairs(node_count * n * n);
  for (std::size_t node = 0; node < node_count; ++node) {
    const std::size_t k = node / static_cast<std::size_t>(step_count);
    const double z = rule.nodes[k], r = std::sqrt(1 - z * z),
                 step = 2 * std::numbers::pi / step_count;
    const double phi = step * static_cast<double>(node % static_cast<std::size_t>(step_count));
    double* y = &single[node * m];
    sh::evaluate(2 * band_count - 1, r * std::cos(phi), r * std::sin(phi), z, {y, m});
    for (std::size_t i = 0; i < n * n; ++i) {
      pairs[node * n * n + i] = rule.weights[k] * step * y[i / n] * y[i % n];
    }
  }
  std::vector<double> products(m * n * n);
  linalg::gemm(1, linalg::MatrixD(single.data(), node_count, m), linalg::Transpose::yes,
               linalg::MatrixD(pairs.data(), node_count, n * n), linalg::Transpose::no, 0,
               linalg::MatrixD(products.data(), m, n * n));
  return {products.begin(), products.end()};
}

}  // namespace prt::transfer
