#include "transfer/matrix_reflection.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "mesh/frame.h"
#include "sh/basis.h"
#include "sh/zonal.h"
#include "transfer/hemisphere.h"
#include "transfer/matrix_kernels.h"
#include "transfer/reflection.h"

namespace prt::transfer {

namespace {

constexpr std::size_t kBlockHits = 1 << 15;
constexpr std::size_t kBatch = 1024;                       // corners evaluated together
constexpr std::size_t kBatchBytes = std::size_t{1} << 19;  // of rows read together

/// In the frame of the corner, not below its horizon.
Vec3 local_direction(const mesh::Frame& frame, const Vec3& w) {
  Vec3 local(w.dot(frame.x), w.dot(frame.y), w.dot(frame.z));
  if (local.z >= 0.0f) return local;
  local.z = 0.0f;
  return local.length() > 0.0f ? local.normalized() : Vec3(1.0f, 0.0f, 0.0f);
}

}  // namespace

MatrixReflection::MatrixReflection(const SceneIndex& index, const Visibility& visibility,
                                   Directions directions, ExitBasis basis, int band_count,
                                   int channel_count)
    : index_(index),
      visibility_(visibility),
      directions_(std::move(directions)),
      basis_(std::move(basis)),
      band_count_(band_count),
      function_count_(sh::row_size(band_count)),
      column_count_(static_cast<std::size_t>(channel_count) * function_count_),
      direction_basis_(directions_.count() * function_count_),
      lobe_(sh::disk_lobe(band_count, std::numbers::pi / 2)),
      ranks_(index.vertex_count(), index.scratch_folder()) {
  const auto weight =
      static_cast<float>(4.0 * std::numbers::pi / static_cast<double>(directions_.count()));
  for (std::size_t d = 0; d < directions_.count(); ++d) {
    sh::evaluate(band_count, directions_[d],
                 {&direction_basis_[d * function_count_], function_count_});
  }
  for (float& value : direction_basis_) value *= weight;
  for_each_trimmed(ranks_.size(), [&](std::size_t i) {
    ranks_[index.vertex_order()[i]] = static_cast<std::uint32_t>(i);
  });
}

std::size_t MatrixReflection::block_size() const {
  return std::clamp<std::size_t>(2 * kBlockHits / std::max<std::size_t>(directions_.count(), 1), 1,
                                 kVertexBlock);
}

/// One block of vertices. Each vertex has a slot for each front face that it sees, and a last one
/// for the mean.
class MatrixReflection::Gather {
 public:
  Gather(const MatrixReflection& owner, const ExitField& field)
      : owner_(owner),
        field_(field),
        hemisphere_(owner.index_, owner.directions_),
        width_(padded_columns(owner.column_count_)),
        halfs_(std::max(kBatchBytes / sizeof(std::uint16_t), field.row_size())) {}

  std::uint64_t run(std::span<const std::uint32_t> vertices, float* transfer, std::size_t stride) {
    for (const std::uint32_t vertex : vertices) trace(owner_.visibility_.stand_ins[vertex]);
    radiance_.assign(directions_of_slots_.size() * width_, 0.0f);
    std::sort(corners_.begin(), corners_.end());
    for (std::size_t begin = 0; begin < corners_.size();) begin = read_batch(begin);
    std::size_t first = 0;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      sum(v, first, transfer + v * owner_.function_count_ * stride, stride);
      first = ends_[v];
    }
    return hemisphere_.rays_cast();
  }

 private:
  static constexpr std::uint32_t kMean = 0xffffffffu;

  /// A corner's place in the field above, its slot and corner number below.
  static std::uint32_t rank(std::uint64_t corner) {
    return static_cast<std::uint32_t>(corner >> 32);
  }
  static std::size_t entry(std::uint64_t corner) { return corner & 0xffffffffu; }

  void trace(std::uint32_t vertex) {
    const std::size_t n = owner_.function_count_;
    std::vector<double> rest(n);  // moments that the shadow rays found blocked, and these did not
    sh::turn_lobe(owner_.lobe_, owner_.index_.normal(vertex), rest);
    const MappedArray<float>& visible = owner_.visibility_.rows;
    const std::size_t visible_stride = visible.size() / owner_.visibility_.stand_ins.size();
    for (std::size_t i = 0; i < n; ++i) rest[i] -= double{visible[vertex * visible_stride + i]};

    hemisphere_.trace(vertex);
    const std::span<const ray::Hit> hits = hemisphere_.hits();
    std::size_t blocked_count = 0;
    for (std::size_t h = 0; h < hits.size(); ++h) {
      if (hits[h].triangle == ray::kNoHit) continue;
      ++blocked_count;
      const std::uint32_t direction = hemisphere_.blocked()[h].row;
      const float* y = &owner_.direction_basis_[direction * n];
      for (std::size_t i = 0; i < n; ++i) rest[i] -= double{y[i]};
      if (!hits[h].back_face) add_slot(hits[h], direction);
    }
    directions_of_slots_.push_back(kMean);
    barycentrics_.resize(3 * directions_of_slots_.size());
    ends_.push_back(directions_of_slots_.size());
    blocked_counts_.push_back(blocked_count);
    rests_.insert(rests_.end(), rest.begin(), rest.end());
  }

  void add_slot(const ray::Hit& hit, std::uint32_t direction) {
    const std::array<std::uint32_t, 3> vertices = owner_.index_.triangle(hit.triangle);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t number = barycentrics_.size() + k;
      corners_.push_back(std::uint64_t{owner_.ranks_[vertices[k]]} << 32 | number);
    }
    barycentrics_.insert(barycentrics_.end(), {1.0f - hit.u - hit.v, hit.u, hit.v});
    directions_of_slots_.push_back(direction);
  }

  /// Exit radiance of the corners from `begin` on, as many as fit; returns the number of the next.
  std::size_t read_batch(std::size_t begin) {
    sources_.clear();
    const std::size_t most = halfs_.size() / field_.row_size();
    std::size_t end = begin;
    for (; end < corners_.size() && end - begin < kBatch; ++end) {
      const std::uint32_t source = rank(corners_[end]);
      if (sources_.empty() || sources_.back().rank != source) {
        if (sources_.size() == most) break;
        sources_.push_back({source, end});
      }
    }
    sources_.push_back({0, end});
    read_rows();
    find_directions(begin, end);
    for (std::size_t s = 0; s + 1 < sources_.size(); ++s) {
      add_source(s, sources_[s].begin - begin, sources_[s + 1].begin - begin);
    }
    return end;
  }

  /// Rows of sources_ into halfs_, runs of neighbours at once.
  void read_rows() {
    const std::size_t size = field_.row_size(), count = sources_.size() - 1;
    for (std::size_t first = 0, next = 0; first < count; first = next) {
      for (next = first + 1; next < count; ++next) {
        if (sources_[next].rank != sources_[next - 1].rank + 1) break;
      }
      field_.read(sources_[first].rank, {&halfs_[first * size], (next - first) * size});
    }
  }

  /// Basis functions towards the receivers, a column a corner.
  void find_directions(std::size_t begin, std::size_t end) {
    for (std::size_t s = 0; s + 1 < sources_.size(); ++s) {
      const auto [primitive, local] =
          owner_.index_.vertex_place(owner_.index_.vertex_order()[sources_[s].rank]);
      const mesh::Frame frame =
          mesh::frame_at_vertex(owner_.index_.scene().primitives[primitive].mesh, local);
      for (std::size_t c = sources_[s].begin; c < sources_[s + 1].begin; ++c) {
        const std::uint32_t direction = directions_of_slots_[entry(corners_[c]) / 3];
        const Vec3 w = local_direction(frame, -owner_.directions_[direction]);
        x_[c - begin] = w.x, y_[c - begin] = w.y, z_[c - begin] = w.z;
      }
    }
    const ExitBasis& basis = owner_.basis_;
    const auto depth = sh::row_size(basis.band_count);
    sh_.resize(depth * kBatch);
    sh::evaluate_batch(basis.band_count, x_.data(), y_.data(), z_.data(), end - begin, sh_.data(),
                       kBatch);
    functions_.assign(basis.function_count * kBatch, 0.0f);
    add_product({basis.from_directions.data(), basis.function_count, sh_.data(), kBatch,
                 functions_.data(), kBatch, basis.function_count, depth,
                 padded_columns(end - begin)});
  }

  /// Adds what one source sends along columns [begin, end) of functions_ to their slots.
  void add_source(std::size_t source, std::size_t begin, std::size_t end) {
    const std::size_t size = field_.row_size();
    row_.resize(size + kProductPadding);  // products read beyond their columns
    half_to_float(&halfs_[source * size], row_.data(), size);
    sent_.assign((end - begin) * width_, 0.0f);
    add_product({&functions_[begin], kBatch, row_.data(), owner_.column_count_, sent_.data(),
                 width_, end - begin, owner_.basis_.function_count, width_});
    for (std::size_t c = begin; c < end; ++c) {
      const std::size_t corner = entry(corners_[sources_[source].begin + c - begin]);
      const float weight = barycentrics_[corner];
      const float* from = &sent_[(c - begin) * width_];
      float* to = &radiance_[corner / 3 * width_];
      for (std::size_t j = 0; j < width_; ++j) to[j] += weight * from[j];
    }
  }

  /// Moments of a vertex whose slots begin at `first`.
  void sum(std::size_t number, std::size_t first, float* transfer, std::size_t stride) {
    const std::size_t n = owner_.function_count_, last = ends_[number] - 1;
    float* mean = &radiance_[last * width_];
    for (std::size_t s = first; s < last; ++s) {
      for (std::size_t j = 0; j < width_; ++j) mean[j] += radiance_[s * width_ + j];
    }
    const float share =
        1.0f / static_cast<float>(std::max<std::size_t>(blocked_counts_[number], 1));
    for (std::size_t j = 0; j < width_; ++j) mean[j] *= share;
    moments_.clear();
    for (std::size_t s = first; s < last; ++s) {
      const float* y = &owner_.direction_basis_[directions_of_slots_[s] * n];
      moments_.insert(moments_.end(), y, y + n);
    }
    moments_.insert(moments_.end(), &rests_[number * n], &rests_[number * n] + n);
    add_product({moments_.data(), n, &radiance_[first * width_], width_, transfer, stride, n,
                 last + 1 - first, width_});
  }

  /// A vertex that others see: its rank, and its first corner.
  struct Source {
    std::uint32_t rank;
    std::size_t begin;
  };

  const MatrixReflection& owner_;
  const ExitField& field_;
  Hemisphere hemisphere_;
  std::size_t width_;  // padded columns
  std::vector<std::uint32_t> directions_of_slots_;
  std::vector<float> barycentrics_;  // three a slot
  std::vector<std::size_t> ends_;    // of each vertex's slots
  std::vector<std::size_t> blocked_counts_;
  std::vector<float> rests_;  // n² a vertex
  std::vector<std::uint64_t> corners_;
  std::vector<float> radiance_;  // a row a slot
  std::vector<Source> sources_;  // of a batch, and the end
  std::vector<std::uint16_t> halfs_;
  std::array<float, kBatch> x_, y_, z_;
  std::vector<float> sh_, functions_, row_, sent_, moments_;
};

std::uint64_t MatrixReflection::add(std::span<const std::uint32_t> vertices, const ExitField& field,
                                    float* transfer, std::size_t stride) const {
  return Gather(*this, field).run(vertices, transfer, stride);
}

}  // namespace prt::transfer
