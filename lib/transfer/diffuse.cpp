#include "transfer/diffuse.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "core/progress.h"
#include "core/range.h"
#include "core/stopwatch.h"
#include "sh/basis.h"
#include "transfer/buried.h"
#include "transfer/clamped_cosine.h"
#include "transfer/header.h"
#include "transfer/interpolation_error.h"
#include "transfer/limits.h"
#include "transfer/reflection.h"
#include "transfer/resume.h"

namespace prt::transfer {

namespace {

constexpr std::size_t kFieldBlock = 1024;  // rows of a parallel block

void check_options(const DiffuseOptions& options) {
  check_range("band count", options.band_count, 1, sh::kMaxBandCount);
  check_range("ray count", options.ray_count, 1, kMaxRayCount);
  check_bounces(options.bounce_count, options.bounce_ray_count, options.shadowed);
}

/// All that decides the values, and bounce_bytes, which decides how bounces are divided.
std::string checkpoint_key(const mesh::Scene& scene, const DiffuseOptions& o) {
  return fmt::format("diffuse {} {} {} {} {} {} {} {} {} {}", mesh::scene_hash(scene), o.band_count,
                     o.ray_count, o.bounce_count, o.bounce_ray_count, o.shadowed,
                     static_cast<int>(o.channels), o.seed, o.closed_form, o.bounce_bytes);
}

/// One bake: the signal's rows hold irradiance, bounces added up, until the last step multiplies
/// them by albedo/pi.
class DiffuseBake {
 public:
  DiffuseBake(const mesh::Scene& scene, const DiffuseOptions& options, DiffuseStats& stats)
      : options_(options),
        stats_(stats),
        index_(scene, options.scratch),
        directions_(make_directions(2 * static_cast<std::size_t>(options.ray_count), options.seed)),
        coefficient_count_(sh::row_size(options.band_count)),
        checkpoint_(options.checkpoint, checkpoint_key(scene, options)),
        signal_(make_header(scene, options)) {
    if (options.shadowed) index_.build_for_shadow_rays(options.ray_count);
    stats_.build_seconds = watch_.seconds();
    signal_.channel_count = choose_channel_count(scene, options.channels, options.bounce_count > 0);
    row_size_ = static_cast<std::size_t>(signal_.dimension());
    signal_.values.resize(index_.vertex_count() * row_size_);
    buried_ = MappedArray<std::uint8_t>(index_.vertex_count(), index_.scratch_folder());
  }

  signal::TransferSignal run() {
    if (options_.bounce_count > 0) make_bounce_fields();
    if (options_.shadowed) {
      direct_pass();
    } else {
      fill_unshadowed();
    }
    MappedArray<float> blocked;
    if (options_.bounce_count > 0) blocked = blocked_irradiance();
    const BuriedRepair repair(index_, buried_);
    repair.apply(signal_.values.data(), row_size_);
    if (options_.bounce_count > 0) bounce(repair, std::move(blocked));
    multiply_albedo();
    count_buried(repair);
    if (options_.shadowed) measure_interpolation(index_, stats_);
    return std::move(signal_);
  }

 private:
  float* row(std::size_t vertex) { return &signal_.values[vertex * row_size_]; }
  float direction_weight() const {
    return static_cast<float>(4.0 * std::numbers::pi / static_cast<double>(directions_.count()));
  }

  void fill_unshadowed() {
    parallel_for(index_.vertex_count(), kVertexBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        clamped_cosine(options_.band_count, index_.normal(v), {row(v), coefficient_count_});
        copy_to_channels(v);
      }
    });
  }

  void direct_pass() {
    const Stopwatch watch;
    const std::vector<float> basis = basis_rows(options_.band_count, directions_);
    const TracedRows traced{signal_.values.data(), row_size_, coefficient_count_, buried_.data()};
    stats_.rays_cast = trace_vertices(
        checkpoint_, index_, traced, "shadows", options_.ray_count,
        [&](std::size_t begin, std::size_t end) { return trace_block(begin, end, basis); }, stats_);
    for (std::size_t v = 0; v < index_.vertex_count(); ++v) copy_to_channels(v);
    stats_.rays_cast += confirm_buried(index_, directions_, buried_);
    stats_.trace_seconds = watch.seconds();
    stats_.rays_per_second = static_cast<double>(stats_.rays_cast) / stats_.trace_seconds;
  }

  std::uint64_t trace_block(std::size_t begin, std::size_t end, const std::vector<float>& basis) {
    Hemisphere hemisphere(index_, directions_);
    std::vector<float> sum(padded(coefficient_count_));
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t vertex = index_.vertex_order()[i];
      hemisphere.trace(vertex);
      find_irradiance(vertex, hemisphere, basis, sum);
      buried_[vertex] = sees_nothing(hemisphere);
    }
    return hemisphere.rays_cast();
  }

  void find_irradiance(std::size_t vertex, Hemisphere& hemisphere, const std::vector<float>& basis,
                       std::vector<float>& sum) {
    const bool closed_form = options_.closed_form;
    std::fill(sum.begin(), sum.end(), 0.0f);
    add_weighted_rows(closed_form ? hemisphere.blocked() : hemisphere.visible(), basis.data(),
                      sum.size(), sum.data());
    const std::span<float> irradiance(row(vertex), coefficient_count_);
    if (closed_form) clamped_cosine(options_.band_count, index_.normal(vertex), irradiance);
    const float weight = closed_form ? -direction_weight() : direction_weight();
    for (std::size_t j = 0; j < coefficient_count_; ++j) irradiance[j] += weight * sum[j];
  }

  void copy_to_channels(std::size_t vertex) {
    for (std::size_t offset = coefficient_count_; offset < row_size_;
         offset += coefficient_count_) {
      std::copy_n(row(vertex), coefficient_count_, row(vertex) + offset);
    }
  }

  /// ∫ (1 - V) max(0, cos) of every vertex: pi less what a constant light brings.
  MappedArray<float> blocked_irradiance() {
    const float constant_basis = 0.5f * std::sqrt(std::numbers::inv_pi_v<float>);
    MappedArray<float> blocked(index_.vertex_count(), index_.scratch_folder());
    for_each_trimmed(blocked.size(), [&](std::size_t v) {
      blocked[v] = std::max(0.0f, std::numbers::pi_v<float> - row(v)[0] / constant_basis);
    });
    return blocked;
  }

  /// How many coefficients are bounced at a time: as many as memory allows, or, where the fields
  /// lie in files, all.
  std::size_t bounced_columns() const {
    const auto channels = static_cast<std::size_t>(signal_.channel_count);
    if (index_.is_large() || index_.vertex_count() == 0) return coefficient_count_;
    const std::size_t fit = options_.bounce_bytes /
                            (3 * sizeof(float) * channels * index_.vertex_count()) / kRowPadding;
    return fit > 0 ? std::min(fit * kRowPadding, padded(coefficient_count_)) : 1;
  }

  /// Bounces act on each coefficient alone: they may go through a few at a time.
  void bounce(const BuriedRepair& repair, MappedArray<float> blocked) {
    if (index_.vertex_count() == 0) return;
    const Stopwatch watch;
    const int rays = choose_bounce_ray_count(options_.bounce_ray_count, options_.ray_count);
    Reflection reflection(index_,
                          make_directions(2 * static_cast<std::size_t>(rays), options_.seed),
                          signal_.channel_count, std::move(blocked), options_.hit_bytes);
    stats_.rays_cast += reflection.trace();
    const std::size_t columns = bounced_columns();
    Progress progress("bounces",
                      block_count(coefficient_count_, columns) *
                          static_cast<std::size_t>(options_.bounce_count) * index_.vertex_count(),
                      "vertices");
    double resumed = 0.0;
    for (std::size_t first = 0; first < coefficient_count_; first += columns) {
      resumed += bounce_columns(repair, reflection, first, columns, progress);
    }
    note_resumed_bounces(resumed / static_cast<double>(coefficient_count_), stats_);
    stats_.bounce_seconds = watch.seconds();
  }

  /// Before anything is traced: a disk that is too small for them is an error at once.
  void make_bounce_fields() {
    const std::size_t size =
        index_.vertex_count() * static_cast<std::size_t>(signal_.channel_count) * bounced_columns();
    state_ = MappedArray<float>(2 * size + 1, index_.scratch_folder());
    next_ = MappedArray<float>(size, index_.scratch_folder());
  }

  /// state_ holds the sum of the bounces so far, the last bounce, and their number: what the
  /// checkpoint keeps, at the end and, in long computations, now and then before. Returns how many
  /// columns' worth of bounces it had.
  double bounce_columns(const BuriedRepair& repair, const Reflection& reflection, std::size_t first,
                        std::size_t columns, Progress& progress) {
    const auto channels = static_cast<std::size_t>(signal_.channel_count);
    const std::size_t used = std::min(columns, coefficient_count_ - first);
    const std::size_t stride = channels * columns, size = index_.vertex_count() * stride;
    float *sum = state_.data(), *field = sum + size, &done = state_[2 * size];
    const auto for_each_segment = [&](const auto& body) {
      for_each_trimmed(index_.vertex_count() * channels, [&](std::size_t i) {
        body(&signal_.values[i * coefficient_count_ + first], i * columns);
      });
    };
    const Checkpoint::Name name{kBounceStage, static_cast<std::uint32_t>(first)};
    if (!checkpoint_.restore(name, std::span(state_))) {
      done = 0.0f;
      for_each_segment([&](const float* value, std::size_t at) {
        std::copy_n(value, used, &sum[at]);
        std::copy_n(value, used, &field[at]);
      });
    }
    const double resumed = static_cast<double>(used) * double{done} / options_.bounce_count;
    progress.advance(static_cast<std::size_t>(done) * index_.vertex_count());
    Stopwatch since_stored;
    while (done < static_cast<float>(options_.bounce_count)) {
      stats_.rays_cast += reflection.gather(field, columns, next_.data());
      repair.apply(next_.data(), stride);
      parallel_for(size, kFieldBlock * stride, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) sum[i] += field[i] = next_[i];
        trim_mapped_arrays();
      });
      ++done;
      if (since_stored.seconds() >= options_.checkpoint.after_seconds ||
          done == static_cast<float>(options_.bounce_count)) {
        checkpoint_.store(name, std::span<const float>(state_));
        since_stored = {};
      }
      progress.advance(index_.vertex_count());
    }
    for_each_segment([&](float* value, std::size_t at) { std::copy_n(&sum[at], used, value); });
    return resumed;
  }

  void multiply_albedo() {
    parallel_for(index_.vertex_count(), kVertexBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const SceneIndex::Place at = index_.vertex_place(v);
        const Vec3 albedo =
            channel_albedo(mesh::albedo_at_vertex(
                               index_.scene(), index_.scene().primitives[at.primitive], at.local),
                           signal_.channel_count);
        for (std::size_t j = 0; j < row_size_; ++j) {
          row(v)[j] *=
              albedo[static_cast<int>(j / coefficient_count_)] * std::numbers::inv_pi_v<float>;
        }
      }
    });
  }

  void count_buried(const BuriedRepair& repair) {
    for (const mesh::Primitive& primitive : index_.scene().primitives) {
      stats_.primitives.push_back(
          {primitive.name, primitive.mesh.vertex_count(), primitive.mesh.triangle_count(), 0});
    }
    for_each_trimmed(buried_.size(), [&](std::size_t v) {
      stats_.primitives[index_.vertex_place(v).primitive].buried_vertex_count += buried_[v];
      stats_.buried_vertex_count += buried_[v];
    });
    stats_.unrepaired_vertex_count = stats_.buried_vertex_count - repair.repaired_count();
  }

  const DiffuseOptions& options_;
  DiffuseStats& stats_;
  Stopwatch watch_;
  SceneIndex index_;
  Directions directions_;
  std::size_t coefficient_count_, row_size_ = 0;
  Checkpoint checkpoint_;
  signal::TransferSignal signal_;
  MappedArray<std::uint8_t> buried_;
  MappedArray<float> state_, next_;  // with bounces only
};

}  // namespace

signal::TransferSignal compute_diffuse(const mesh::Scene& scene, const DiffuseOptions& options,
                                       DiffuseStats& stats) {
  check_options(options);
  stats = {};
  return DiffuseBake(scene, options, stats).run();
}

}  // namespace prt::transfer
