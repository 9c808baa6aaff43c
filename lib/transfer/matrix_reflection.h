// Interreflection of glossy surfaces [Sloan, Kautz, Snyder 2002], [Sloan03] §3: what a vertex
// receives from others under each light function j, as moments over the sphere,
//   T_ij += Σ_d w y_i(d) L_j(d),
// over a set of directions d that other surfaces block, where L_j(d) is the exit radiance towards
// -d of the point that d hits first: of each corner of its triangle in the corner's own frame, and
// interpolated between them. Below a corner's horizon, where its triangle alone faces d, its exit
// radiance is that along the horizon. Backs of faces are black.
//
// This set is smaller than that of the shadow rays (transfer/matrix_visibility.h) and sees slightly
// other moments of what is blocked. So it gives only how L_j differs from its mean; the mean itself
// has the shadow rays' moments. What constant surroundings block and what they reflect balance
// exactly, for every BRDF.
//
// The sums are products of small matrices: what lies in one corner's hemisphere (directions ×
// functions) times its field (functions × lights), and y_i(d)ᵀ (functions × directions) times
// L_j(d) (directions × lights).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mapped_array.h"
#include "transfer/directions.h"
#include "transfer/matrix_field.h"
#include "transfer/matrix_visibility.h"
#include "transfer/scene_index.h"

namespace prt::transfer {

class MatrixReflection {
 public:
  /// Of n = band_count bands of light; `directions` over the sphere. Index and visibility must
  /// outlive this.
  MatrixReflection(const SceneIndex& index, const Visibility& visibility, Directions directions,
                   ExitBasis basis, int band_count, int channel_count);

  const ExitBasis& basis() const { return basis_; }
  /// Of fields: basis functions × channels × n², row rank(v) for vertex v.
  std::size_t field_row_size() const { return basis_.function_count * column_count_; }
  /// Place in the order of fields.
  std::uint32_t rank(std::uint32_t vertex) const { return ranks_[vertex]; }

  /// How many vertices, neighbours in that order, add() should get at a time.
  std::size_t block_size() const;

  /// Adds what each of the vertices receives to its n² rows of `stride` floats, padded_columns() of
  /// channels × n² at least, channel after channel; what stands behind these has no meaning.
  /// Returns the number of rays cast.
  std::uint64_t add(std::span<const std::uint32_t> vertices, const ExitField& field,
                    float* transfer, std::size_t stride) const;

 private:
  class Gather;

  const SceneIndex& index_;
  const Visibility& visibility_;
  Directions directions_;
  ExitBasis basis_;
  int band_count_;
  std::size_t function_count_;          // n²
  std::size_t column_count_;            // channels × n²
  std::vector<float> direction_basis_;  // directions × n²: w y_i(d)
  std::vector<double> lobe_;            // the hemisphere about +Z
  MappedArray<std::uint32_t> ranks_;
};

}  // namespace prt::transfer
