// What the surfaces of a scene make of incident radiance: the operators A⁻¹ B A⁻¹ of
// transfer/matrix.h at each vertex, from the options' BRDF or from glTF's materials.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "brdf/brdf.h"
#include "mesh/scene.h"
#include "sh/hemisphere.h"

namespace prt::transfer {

struct SurfaceOptions {
  std::string brdf = "from-material";  ///< by brdf::kBrdfSyntax
  int band_count = 5;                  ///< of incident radiance
  int row_count = 25;                  ///< of exit radiance, for sh::hemisphere_functions()
  sh::HemisphereProjection projection = sh::HemisphereProjection::least_squares;
};

/// A⁻¹ B A⁻¹, row_count × band_count² values. Warns as brdf::brdf_matrix does.
std::vector<float> exit_operator(const brdf::Brdf& brdf, const SurfaceOptions& options);

class MatrixSurfaces {
 public:
  /// Throws Error (usage). The scene must outlive this.
  MatrixSurfaces(const mesh::Scene& scene, const SurfaceOptions& options, int channel_count);

  /// Values that at_vertex() gives for a channel.
  std::size_t operator_size() const { return operator_size_; }
  /// The operator of a vertex for each channel, transposed: band_count² × row_count.
  void at_vertex(const mesh::Primitive& primitive, std::size_t vertex,
                 std::span<float> operators) const;

 private:
  /// One term a lobe: colour times operator. A BRDF that the options name is one term, whose colour
  /// is the albedo.
  struct Surface {
    brdf::MetallicRoughness material{};  ///< but its base colour
    std::vector<std::size_t> lobes{};    ///< of brdf::material_lobes(), a term each
    std::vector<std::vector<float>> terms{};
  };
  Surface surface_of(const mesh::Material& from, const SurfaceOptions& options) const;
  std::vector<Vec3> term_colours(const Surface& surface, const Vec3& albedo) const;

  const mesh::Scene& scene_;
  int channel_count_;
  std::size_t operator_size_;
  bool from_material_ = false;
  std::vector<Surface> surfaces_;  ///< a material each, that of material -1 last; or a single one
};

}  // namespace prt::transfer
