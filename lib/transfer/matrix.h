// Exit-radiance transfer matrices [Sloan03] §3: how each vertex turns distant light into the
// radiance that it sends in every direction,
//   M_p = A⁻¹ B A⁻¹ R_p T_p,
// where T_p are the moments of what the vertex receives under each light function, from the light
// itself (transfer/matrix_visibility.h) and from other surfaces (transfer/matrix_reflection.h), R_p
// turns them into the vertex's frame (mesh/frame.h), B is the BRDF's matrix (brdf/brdf_matrix.h)
// and A⁻¹ the least squares projection onto the hemisphere, for incident radiance in the light's
// bands and for exit radiance in the rows' functions (sh/hemisphere.h).
//
// The field M⁰ of direct light, M¹ of one bounce more, … follow from each other, all vertices at
// once; they wait in files (transfer/matrix_field.h). The last is made as it is asked for and goes
// to disk block by block.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/progress.h"
#include "mesh/frame.h"
#include "mesh/scene.h"
#include "sh/hemisphere.h"
#include "signal/transfer_signal.h"
#include "transfer/diffuse.h"
#include "transfer/matrix_reflection.h"
#include "transfer/matrix_surface.h"
#include "transfer/matrix_visibility.h"

namespace prt::transfer {

/// Fewer rows are no function of direction; a file of one row holds exit radiance itself.
constexpr int kMinMatrixRowCount = 3;

struct MatrixOptions {
  /// By brdf::kBrdfSyntax. Base colours are factors of the BRDFs that it names; from-material reads
  /// mesh::Material, at each vertex where there are textures.
  std::string brdf = "from-material";
  int band_count = 5;        ///< of the light, 1 to kMaxMatrixBandCount
  int row_count = 25;        ///< of exit radiance: n², or n² - 1 without l = 1, m = 0, 3 to 256
  int ray_count = 2048;      ///< per vertex, over its hemisphere (on average)
  int bounce_count = 0;      ///< of interreflection; needs shadowed
  int bounce_ray_count = 0;  ///< as of DiffuseOptions
  bool shadowed = true;      ///< false: no rays
  ChannelMode channels = ChannelMode::automatic;
  std::uint64_t seed = 1;  ///< turns the set of directions
  /// Of incident and of exit radiance; others than least squares are for comparison.
  sh::HemisphereProjection projection = sh::HemisphereProjection::least_squares;
  /// Where the fields of bounces are: half of the matrices' size, for more than one bounce all of
  /// it.
  std::filesystem::path scratch_folder = std::filesystem::temp_directory_path();
  CheckpointOptions checkpoint{};  ///< where to keep what is done, for a run that continues it
};

class MatrixTransfer {
 public:
  /// Casts the shadow rays, and does all bounces but the last. The scene must outlive this, and so
  /// must `stats`, to which compute() adds its share of bounces. Throws Error (usage) on options
  /// out of range, Error (bad_input) on positions or normals that are not finite and Error (failed)
  /// when the scratch folder has no room.
  MatrixTransfer(const mesh::Scene& scene, const MatrixOptions& options, DiffuseStats& stats);

  MatrixTransfer(const MatrixTransfer&) = delete;
  MatrixTransfer& operator=(const MatrixTransfer&) = delete;

  /// All of the signal but its values.
  const signal::TransferSignal& header() const { return header_; }
  const MatrixSurfaces& surfaces() const { return surfaces_; }
  /// Of all files that were in the scratch folder at once.
  std::size_t scratch_bytes() const {
    return field_ ? field_->byte_count() * (header_.bounce_count > 1 ? 2 : 1) : 0;
  }

  /// Rows of the signal of vertices [first, first + count), ordered as TransferSignal says:
  /// count × header().dimension() values. All processors; the same bytes for any number. Throws
  /// Error (failed) when the scratch file cannot be read.
  void compute(std::size_t first, std::size_t count, std::span<float> values);

 private:
  /// Takes the matrix of the i-th vertex of a block: rows of matrix_stride_ floats, channel after
  /// channel.
  using MatrixSink = std::function<void(std::size_t i, const float* matrix)>;

  void bounce(const MatrixOptions& options);
  void note_resumed(int first, const ExitField& field);
  void fill_field(int bounce, ExitField& field, Progress& progress);
  std::uint64_t compute_block(std::span<const std::uint32_t> vertices,
                              const MatrixSink& sink) const;
  void reflect(std::span<const std::uint32_t> vertices, const std::vector<float>& moments,
               const MatrixSink& sink) const;
  void turn(const mesh::Frame& frame, const float* moments, float* turned) const;
  void to_field(const float* matrix, float* row) const;

  const mesh::Scene& scene_;
  DiffuseStats& stats_;
  signal::TransferSignal header_;
  std::vector<std::size_t> vertex_offsets_;
  std::unique_ptr<SceneIndex> index_;  // while rays are cast
  Visibility visibility_;
  std::vector<float> triple_;  // triple_products()
  MatrixSurfaces surfaces_;
  Checkpoint checkpoint_;
  std::unique_ptr<MatrixReflection> reflection_;  // these two with bounces only
  std::unique_ptr<ExitField> field_;              // of all bounces but the last
  std::size_t incident_channel_count_ = 1;        // without bounces all channels receive the same
  std::size_t moment_stride_ = 0, matrix_stride_ = 0;
};

/// All matrices of a small scene in memory.
signal::TransferSignal compute_matrices(const mesh::Scene& scene, const MatrixOptions& options,
                                        DiffuseStats& stats);

}  // namespace prt::transfer
