// Reflection models: coloured sums of lobes (brdf/lobe.h), from glTF materials or from text.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "brdf/lobe.h"

namespace prt::brdf {

using Colour = Imath::V3d;  ///< linear Rec. 709

struct WeightedLobe {
  Colour colour;
  LobePointer lobe;
};

struct Brdf {
  std::vector<WeightedLobe> lobes;
  /// The lobes' x axis is the tangent turned by this about the normal, radians, counter-clockwise.
  double rotation = 0;
};

/// A coloured lobe that someone else owns: a sum of them is made for each point without cost.
struct Term {
  Colour colour{0, 0, 0};
  const Lobe* lobe = nullptr;
};

/// Σ colour · lobe, 1/sr, in the lobes' frame. At least one term, as in all that follow.
Colour evaluate(std::span<const Term> terms, const Direction& light, const Direction& eye);

/// A direction to the light: a lobe is chosen by u0 (brightest channel of its colour times its
/// importance), sampled by u1 and u2. As Lobe::sample, it can be below the surface.
Direction sample(std::span<const Term> terms, const Direction& eye, double u0, double u1,
                 double u2);
double pdf(std::span<const Term> terms, const Direction& light, const Direction& eye);

/// The same of a whole BRDF, in the frame of normal and tangent.
Colour evaluate(const Brdf& brdf, const Direction& light, const Direction& eye);
Direction sample(const Brdf& brdf, const Direction& eye, double u0, double u1, double u2);
double pdf(const Brdf& brdf, const Direction& light, const Direction& eye);

/// A glTF 2.0 metallic-roughness material, factors and textures multiplied, in glTF's terms.
struct MetallicRoughness {
  Colour base_color{1, 1, 1};
  double metallic = 1;
  double roughness = 1;
  double ior = 1.5;                ///< KHR_materials_ior; 0 stands for infinity
  double specular = 1;             ///< KHR_materials_specular, specularFactor
  Colour specular_color{1, 1, 1};  ///< and specularColorFactor
  bool has_anisotropy = false;     ///< KHR_materials_anisotropy, and what belongs to it:
  double anisotropy_strength = 0;
  double anisotropy_rotation = 0;  ///< radians, counter-clockwise from the tangent
};

/// The four lobes of a material: make_brdf's terms, whose colours alone depend on the base colour.
constexpr std::size_t kMaterialLobeCount = 4;
std::array<LobePointer, kMaterialLobeCount> material_lobes(const MetallicRoughness& material);
std::array<Colour, kMaterialLobeCount> material_colours(const MetallicRoughness& material);

/// The material's BRDF by glTF 2.0 Appendix B with the formulas of the three extensions: at most
/// four lobes. alpha = roughness² is at least kMinAlpha; masking is height-correlated where
/// KHR_materials_anisotropy is present. As the specification says of it, the sum of its diffuse
/// and specular terms can reflect more than it receives at grazing angles.
Brdf make_brdf(const MetallicRoughness& material);

/// What --brdf accepts, for help and messages.
constexpr std::string_view kBrdfSyntax =
    "from-material, lambert, ggx:ALPHA[,ALPHA_Y], phong:N, ward:ALPHA[,ALPHA_Y] or "
    "ashikhmin-shirley:N_U,N_V[,RS]";

/// The white BRDF that the text names; nothing for from-material. ALPHA in [0.001, 1], N in [1,
/// 1e6], N_U and N_V in [0, 1e6], RS, the specular reflectance along the normal, in [0, 1] (1: no
/// diffuse lobe). Throws Error (usage).
std::optional<Brdf> parse_brdf(std::string_view text);

}  // namespace prt::brdf
