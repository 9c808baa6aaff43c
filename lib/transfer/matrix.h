// Exit-radiance transfer matrices [Sloan03] §3: how each vertex turns distant light into the
// radiance that it sends in every direction,
//   M_p = A⁻¹ B A⁻¹ R_p T_p,
// where T_p are the moments of what the vertex sees of each light function
// (transfer/matrix_visibility.h), R_p turns them into the vertex's frame (mesh/frame.h), B is the
// BRDF's matrix (brdf/brdf_matrix.h) and A⁻¹ the least squares projection onto the hemisphere, for
// incident radiance in the light's bands and for exit radiance in the rows' functions
// (sh/hemisphere.h).
//
// Matrices are made block by block from the visibility, never all at once: they go to disk as they
// come.
#pragma once

#include <span>
#include <vector>

#include "brdf/brdf.h"
#include "mesh/scene.h"
#include "sh/hemisphere.h"
#include "signal/transfer_signal.h"
#include "transfer/diffuse.h"

namespace prt::transfer {

struct MatrixOptions {
  /// By brdf::kBrdfSyntax. Base colours are factors of the BRDFs that it names; from-material reads
  /// the factors of mesh::Material, with the vertex's albedo as base colour.
  std::string brdf = "from-material";
  int band_count = 5;    ///< of the light, 1 to kMaxMatrixBandCount
  int row_count = 25;    ///< of exit radiance: n², or n² - 1 without l = 1, m = 0
  int ray_count = 2048;  ///< per vertex, over its hemisphere (on average)
  bool shadowed = true;  ///< false: no rays
  ChannelMode channels = ChannelMode::automatic;
  std::uint64_t seed = 1;  ///< turns the set of directions
  /// Of incident and of exit radiance; others than least squares are for comparison.
  sh::HemisphereProjection projection = sh::HemisphereProjection::least_squares;
};

/// A surface's matrices: one term a lobe (or sum of lobes of one colour), A⁻¹ B A⁻¹ one below the
/// other, and what their colours follow from.
struct SurfaceOperator {
  std::size_t term_count = 1;
  std::vector<float> values;           ///< (term_count · row_count) × band_count²
  bool from_material = false;          ///< false: the one term's colour is the albedo
  brdf::MetallicRoughness material{};  ///< but its base colour
  std::vector<std::size_t> lobes{};    ///< of material_lobes(), a term each
};

class MatrixTransfer {
 public:
  /// Casts the rays. The scene must outlive this. Throws Error (usage) on options out of range and
  /// Error (bad_input) on positions or normals that are not finite.
  MatrixTransfer(const mesh::Scene& scene, const MatrixOptions& options, DiffuseStats& stats);

  /// All of the signal but its values.
  const signal::TransferSignal& header() const { return header_; }

  /// Rows of the signal of vertices [first, first + count), ordered as TransferSignal says:
  /// count × header().dimension() values. All processors; the same bytes for any number.
  void compute(std::size_t first, std::size_t count, std::span<float> values) const;

 private:
  struct Run;  // consecutive vertices of one primitive
  void compute_run(const Run& run, float* values) const;
  void turn(const Run& run, std::size_t number, const float* moments, float* turned) const;
  void store(const Run& run, const SurfaceOperator& surface, const std::vector<float>& exit,
             float* values) const;

  const mesh::Scene& scene_;
  signal::TransferSignal header_;
  std::vector<std::size_t> vertex_offsets_;
  std::vector<float> visibility_;          // a row a vertex
  std::vector<float> triple_;              // triple_products()
  std::vector<SurfaceOperator> surfaces_;  // a material each, that of material -1 last
};

/// A⁻¹ B A⁻¹ for exit functions sh::hemisphere_functions(row_count), row_count × band_count²
/// values, or another projection's matrix for both A⁻¹. Warns as brdf::brdf_matrix does.
std::vector<float> exit_operator(const brdf::Brdf& brdf, int row_count, int band_count,
                                 sh::HemisphereProjection projection);

/// All matrices of a small scene in memory.
signal::TransferSignal compute_matrices(const mesh::Scene& scene, const MatrixOptions& options,
                                        DiffuseStats& stats);

}  // namespace prt::transfer
