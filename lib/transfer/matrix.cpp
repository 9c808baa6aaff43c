#include "transfer/matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <numeric>

#include "core/error.h"
#include "core/exit_rows.h"
#include "core/mapped_array.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/range.h"
#include "core/stopwatch.h"
#include "linalg/product.h"
#include "mesh/frame.h"
#include "sh/basis.h"
#include "transfer/channels.h"
#include "transfer/header.h"
#include "transfer/limits.h"
#include "transfer/matrix_kernels.h"
#include "transfer/reflection.h"
#include "transfer/resume.h"

namespace prt::transfer {

namespace {

using linalg::ConstMatrixF;
using linalg::MatrixF;
using linalg::Transpose;

// Visibility of more vertices than this holds, and all else of them, lies in files.
constexpr std::size_t kMostVisibilityBytes = std::size_t{384} << 20;

void check_options(const MatrixOptions& options) {
  check_range("band count of a transfer matrix", options.band_count, 1, kMaxMatrixBandCount);
  check_range("ray count", options.ray_count, 1, kMaxRayCount);
  check_bounces(options.bounce_count, options.bounce_ray_count, options.shadowed);
  check_range("row count of a transfer matrix", options.row_count, kMinMatrixRowCount,
              kMaxExitRowCount);
  sh::hemisphere_functions(options.row_count);
}

bool has_coloured_specular(const mesh::Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(), [](const auto& m) {
    return m.specular_color.x != m.specular_color.y || m.specular_color.y != m.specular_color.z;
  });
}

signal::TransferSignal make_matrix_header(const mesh::Scene& scene, const MatrixOptions& options) {
  check_options(options);
  signal::TransferSignal header = make_header(scene, options);
  header.row_count = options.row_count;
  header.channel_count = choose_channel_count(scene, options.channels, false);
  if (options.channels == ChannelMode::automatic && options.brdf == "from-material" &&
      has_coloured_specular(scene)) {
    header.channel_count = 3;
  }
  if (header.dimension() > signal::kMaxDimension) {
    throw Error(ErrorKind::usage, "transfer matrices too large for a file",
                {.found = fmt::format("{} × {} × {} coefficients", header.channel_count,
                                      header.row_count, sh::row_size(header.band_count)),
                 .expected = fmt::format("at most {}", signal::kMaxDimension),
                 .advice = "Ask for fewer with --bands or --rows."});
  }
  header.brdf = options.brdf;
  return header;
}

/// All that decides the values.
std::string checkpoint_key(const mesh::Scene& scene, const MatrixOptions& o, int channel_count) {
  return fmt::format("matrix {} {} {} {} {} {} {} {} {} {} {}", mesh::scene_hash(scene), o.brdf,
                     o.band_count, o.row_count, o.ray_count, o.bounce_count, o.bounce_ray_count,
                     o.shadowed, channel_count, o.seed, static_cast<int>(o.projection));
}

}  // namespace

MatrixTransfer::MatrixTransfer(const mesh::Scene& scene, const MatrixOptions& options,
                               DiffuseStats& stats)
    : scene_(scene),
      stats_(stats),
      header_(make_matrix_header(scene, options)),
      vertex_offsets_(scene.vertex_offsets()),
      triple_(triple_products(options.band_count)),
      surfaces_(scene, {options.brdf, options.band_count, options.row_count, options.projection},
                header_.channel_count),
      checkpoint_(options.checkpoint, checkpoint_key(scene, options, header_.channel_count)) {
  stats_ = {};
  const std::size_t n = sh::row_size(options.band_count);
  const auto channels = static_cast<std::size_t>(header_.channel_count);
  if (options.bounce_count > 0) incident_channel_count_ = channels;
  moment_stride_ = padded_columns(incident_channel_count_ * n);
  matrix_stride_ = padded_columns(n);
  const Stopwatch watch;
  ScratchOptions scratch{.folder = options.scratch_folder};
  scratch.in_memory_vertices =
      std::min(scratch.in_memory_vertices,
               kMostVisibilityBytes / (sizeof(float) * sh::row_size(2 * options.band_count - 1)));
  index_ = std::make_unique<SceneIndex>(scene, scratch);
  if (options.shadowed) index_->build_for_shadow_rays(options.ray_count);
  stats_.build_seconds = watch.seconds();
  visibility_ = compute_visibility(
      *index_, {2 * options.band_count - 1, options.ray_count, options.shadowed, options.seed},
      checkpoint_, stats_);
  if (options.bounce_count > 0) {
    bounce(options);
  } else {
    index_.reset();
  }
}

// Fields of 0, 1, … bounces, all but the last. Of those that an interrupted run has left the last
// whole one is needed, and what there is of the next.
void MatrixTransfer::bounce(const MatrixOptions& options) {
  const Stopwatch watch;
  index_->engine();
  const int rays = choose_bounce_ray_count(options.bounce_ray_count, options.ray_count);
  reflection_ = std::make_unique<MatrixReflection>(
      *index_, visibility_, make_directions(2 * static_cast<std::size_t>(rays), options.seed),
      ExitBasis(sh::hemisphere_functions(options.row_count)), options.band_count,
      header_.channel_count);
  const std::size_t vertex_count = index_->vertex_count();
  const auto make_field = [&] {
    return std::make_unique<ExitField>(options.scratch_folder, vertex_count,
                                       reflection_->field_row_size());
  };
  std::unique_ptr<ExitField> next = make_field();
  std::unique_ptr<ExitField> spare = options.bounce_count > 1 ? make_field() : nullptr;
  Progress progress("bounces", vertex_count * static_cast<std::size_t>(options.bounce_count),
                    "vertices");
  int b = options.bounce_count - 1;
  while (b > 0 && checkpoint_.byte_count(field_stage(b)) < next->byte_count()) --b;
  note_resumed(b, *next);
  progress.advance(static_cast<std::size_t>(b) * vertex_count);
  for (; b < options.bounce_count; ++b) {
    fill_field(b, *next, progress);
    if (b > 0) checkpoint_.release(field_stage(b - 1));
    std::swap(field_, next);
    if (!next) next = std::move(spare);
  }
  stats_.bounce_seconds = watch.seconds();
}

/// From the field that is restored first on.
void MatrixTransfer::note_resumed(int first, const ExitField& field) {
  double done = first;
  for (int b = first; b < header_.bounce_count; ++b) {
    done += static_cast<double>(checkpoint_.byte_count(field_stage(b))) /
            static_cast<double>(field.byte_count());
  }
  const std::size_t output_bytes =
      header_.vertex_count() * static_cast<std::size_t>(header_.dimension()) * sizeof(float);
  done +=
      static_cast<double>(checkpoint_.byte_count(kOutputStage)) / static_cast<double>(output_bytes);
  note_resumed_bounces(done / (header_.bounce_count + 1), stats_);
}

void MatrixTransfer::fill_field(int bounce, ExitField& field, Progress& progress) {
  const std::size_t row_size = field.row_size(), block = reflection_->block_size();
  std::atomic<std::uint64_t> rays{0};
  parallel_for(index_->vertex_count(), block, [&](std::size_t begin, std::size_t end) {
    const Checkpoint::Name name{field_stage(bounce), static_cast<std::uint32_t>(begin / block)};
    std::vector<std::uint16_t> halfs((end - begin) * row_size);
    if (!checkpoint_.restore(name, std::span(halfs))) {
      std::vector<float> rows(halfs.size());
      rays += compute_block(
          index_->vertex_order().subspan(begin, end - begin),
          [&](std::size_t i, const float* matrix) { to_field(matrix, &rows[i * row_size]); });
      float_to_half(rows.data(), halfs.data(), halfs.size());
      checkpoint_.store(name, std::span<const std::uint16_t>(halfs));
    }
    field.write(begin, halfs);
    progress.advance(end - begin);
  });
  stats_.rays_cast += rays;
}

void MatrixTransfer::compute(std::size_t first, std::size_t count, std::span<float> values) {
  const Stopwatch watch;
  // Without bounces matrices are made about as fast as they are read.
  const Checkpoint::Name name{kOutputStage, static_cast<std::uint32_t>(first)};
  if (reflection_ && checkpoint_.restore(name, values)) return;
  std::vector<std::uint32_t> vertices(count);
  std::iota(vertices.begin(), vertices.end(), static_cast<std::uint32_t>(first));
  if (reflection_) {
    std::sort(vertices.begin(), vertices.end(), [&](std::uint32_t a, std::uint32_t b) {
      return reflection_->rank(a) < reflection_->rank(b);
    });
  }
  const std::size_t n = sh::row_size(header_.band_count);
  const auto dimension = static_cast<std::size_t>(header_.dimension());
  std::atomic<std::uint64_t> rays{0};
  parallel_for(count, reflection_ ? reflection_->block_size() : kVertexBlock,
               [&](std::size_t begin, std::size_t end) {
                 rays += compute_block(
                     {&vertices[begin], end - begin}, [&](std::size_t i, const float* matrix) {
                       float* to = &values[(vertices[begin + i] - first) * dimension];
                       for (std::size_t r = 0; r < dimension / n; ++r) {
                         std::copy_n(matrix + r * matrix_stride_, n, to + r * n);
                       }
                     });
               });
  if (reflection_) checkpoint_.store(name, std::span<const float>(values));
  stats_.rays_cast += rays;
  (reflection_ ? stats_.bounce_seconds : stats_.matrix_seconds) += watch.seconds();
}

// Vertices side by side, so that the product for T_p is of matrices, not of vectors.
std::uint64_t MatrixTransfer::compute_block(std::span<const std::uint32_t> vertices,
                                            const MatrixSink& sink) const {
  const std::size_t n = sh::row_size(header_.band_count), count = vertices.size();
  const std::size_t m = sh::row_size(2 * header_.band_count - 1);
  std::vector<float> visible(count * m), direct(count * n * n);
  for (std::size_t v = 0; v < count; ++v) {
    std::copy_n(&visibility_.rows[vertices[v] * m], m, &visible[v * m]);
  }
  trim_mapped_arrays();
  linalg::gemm(1.0f, ConstMatrixF(visible.data(), count, m), Transpose::no,
               ConstMatrixF(triple_.data(), m, n * n), Transpose::no, 0.0f,
               MatrixF(direct.data(), count, n * n));
  std::vector<float> moments(count * n * moment_stride_);
  for (std::size_t row = 0; row < count * n; ++row) {
    for (std::size_t c = 0; c < incident_channel_count_; ++c) {
      std::copy_n(&direct[row * n], n, &moments[row * moment_stride_ + c * n]);
    }
  }
  const std::uint64_t rays =
      field_ ? reflection_->add(vertices, *field_, moments.data(), moment_stride_) : 0;
  reflect(vertices, moments, sink);
  return rays;
}

void MatrixTransfer::reflect(std::span<const std::uint32_t> vertices,
                             const std::vector<float>& moments, const MatrixSink& sink) const {
  const std::size_t n = sh::row_size(header_.band_count), size = n * moment_stride_;
  const auto channels = static_cast<std::size_t>(header_.channel_count);
  const auto rows = static_cast<std::size_t>(header_.row_count);
  std::vector<float> operators(channels * surfaces_.operator_size());
  std::vector<float> turned(size + kProductPadding), matrix(channels * rows * matrix_stride_);
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const auto next = std::upper_bound(vertex_offsets_.begin(), vertex_offsets_.end(), vertices[v]);
    const auto number = static_cast<std::size_t>(next - vertex_offsets_.begin()) - 1;
    const mesh::Primitive& primitive = scene_.primitives[number];
    const std::size_t local = vertices[v] - vertex_offsets_[number];
    turn(mesh::frame_at_vertex(primitive.mesh, local), &moments[v * size], turned.data());
    surfaces_.at_vertex(primitive, local, operators);
    std::fill(matrix.begin(), matrix.end(), 0.0f);
    for (std::size_t c = 0; c < channels; ++c) {
      const std::size_t first = incident_channel_count_ > 1 ? c * n : 0;
      add_product({&operators[c * surfaces_.operator_size()], rows, &turned[first], moment_stride_,
                   &matrix[c * rows * matrix_stride_], matrix_stride_, rows, n, matrix_stride_});
    }
    sink(v, matrix.data());
  }
}

signal::TransferSignal compute_matrices(const mesh::Scene& scene, const MatrixOptions& options,
                                        DiffuseStats& stats) {
  MatrixTransfer transfer(scene, options, stats);
  signal::TransferSignal signal = transfer.header();
  signal.values.resize(signal.vertex_count() * static_cast<std::size_t>(signal.dimension()));
  transfer.compute(0, signal.vertex_count(), signal.values);
  return signal;
}

}  // namespace prt::transfer
