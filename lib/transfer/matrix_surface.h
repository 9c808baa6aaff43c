// What the surfaces of a scene make of incident radiance: the operators A⁻¹ B A⁻¹ of
// transfer/matrix.h at each vertex, from the options' BRDF or from glTF's materials.
//
// A material's operator is a sum over its lobes (brdf::material_lobes), whose colours follow from
// the base colour and metallic of the vertex. Where a texture changes the roughness, those of the
// microfacet lobes are cubics in it through four of the nodes 0, 1/12, … 1: within kBlendError of
// the exact ones.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "brdf/brdf_matrix.h"
#include "core/progress.h"
#include "mesh/scene.h"
#include "sh/hemisphere.h"

namespace prt::transfer {

struct SurfaceOptions {
  std::string brdf = "from-material";  ///< by brdf::kBrdfSyntax
  int band_count = 5;                  ///< of incident radiance
  int row_count = 25;                  ///< of exit radiance, for sh::hemisphere_functions()
  sh::HemisphereProjection projection = sh::HemisphereProjection::least_squares;
};

/// A⁻¹ B A⁻¹ of the BRDF's first channel, row_count × band_count² values.
std::vector<float> exit_operator(const brdf::BrdfMatrix& matrix, const SurfaceOptions& options);

constexpr int kRoughnessSteps = 12;
/// Of exit radiance, relative and RMS over the hemisphere and all light of five bands, for
/// isotropic materials of roughness 0.2 to 1.
constexpr double kBlendError = 2e-3;

/// The cubic through nodes first … first + 3 of the roughness.
struct RoughnessBlend {
  int first;
  std::array<double, 4> weights;
};
RoughnessBlend blend_roughness(double roughness);

/// What the bands cannot show of a BRDF.
struct SurfaceLoss {
  std::string name;  ///< of the material, or its number, or the BRDF that the options name
  brdf::BandLoss loss;
  double matrix_error;  ///< of an entry of B
};

class MatrixSurfaces {
 public:
  /// Warns of losses, and of anisotropic surfaces without tangents. Throws Error (usage). The scene
  /// must outlive this.
  MatrixSurfaces(const mesh::Scene& scene, const SurfaceOptions& options, int channel_count);

  const std::vector<SurfaceLoss>& losses() const { return losses_; }
  /// That the BRDF matrices took.
  double seconds() const { return seconds_; }

  /// Values that at_vertex() gives for a channel.
  std::size_t operator_size() const { return operator_size_; }
  /// The operator of a vertex for each channel, transposed: band_count² × row_count.
  void at_vertex(const mesh::Primitive& primitive, std::size_t vertex,
                 std::span<float> operators) const;

 private:
  /// A lobe at all nodes from `first` on, or, where it does not change, once.
  struct Term {
    std::size_t lobe;  ///< of brdf::material_lobes()
    std::vector<std::vector<float>> operators;
  };
  struct Surface {
    bool used = false;
    brdf::MetallicRoughness material{};  ///< but its base colour, metallic and roughness
    double lowest = 1, highest = 0;      ///< roughness
    int first = 0, count = 1;            ///< nodes
    std::vector<Term> terms{};
  };

  void find_used();
  void fill_surfaces();
  void fill(Surface& surface, const mesh::Material& from, const std::string& name,
            Progress& progress);
  void warn_of_missing_tangents(const brdf::Brdf* named) const;
  std::vector<float> make_operator(const brdf::Brdf& brdf) const;
  void note_loss(const brdf::Brdf& brdf, const std::string& name);
  void add_material(const mesh::Primitive& primitive, std::size_t vertex,
                    std::span<float> operators) const;
  void add(const Vec3& factor, const std::vector<float>& from, std::span<float> operators) const;

  const mesh::Scene& scene_;
  SurfaceOptions options_;
  int channel_count_;
  std::size_t operator_size_;
  std::vector<float> named_;       ///< operator of the BRDF that the options name
  std::vector<Surface> surfaces_;  ///< or a material each, that of material -1 last
  std::vector<SurfaceLoss> losses_;
  double seconds_ = 0;
};

}  // namespace prt::transfer
