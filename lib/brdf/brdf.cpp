#include "brdf/brdf.h"

#include <algorithm>
#include <cmath>

namespace prt::brdf {

namespace {

Direction turned(const Direction& w, double angle) {
  if (angle == 0) return w;
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * w.x - s * w.y, s * w.x + c * w.y, w.z};
}

std::vector<Term> terms_of(const Brdf& brdf) {
  std::vector<Term> terms;
  for (const WeightedLobe& from : brdf.lobes) terms.push_back({from.colour, from.lobe.get()});
  return terms;
}

double weight(const Term& term, const Direction& eye) {
  return std::max({term.colour.x, term.colour.y, term.colour.z}) * term.lobe->importance(eye);
}

double total_weight(std::span<const Term> terms, const Direction& eye) {
  double sum = 0;
  for (const Term& term : terms) sum += weight(term, eye);
  return sum;
}

}  // namespace

Colour evaluate(std::span<const Term> terms, const Direction& light, const Direction& eye) {
  Colour sum(0, 0, 0);
  for (const Term& term : terms) sum += term.colour * term.lobe->evaluate(light, eye);
  return sum;
}

// Black materials reflect nothing whatever the direction: the last lobe is as good as any.
Direction sample(std::span<const Term> terms, const Direction& eye, double u0, double u1,
                 double u2) {
  double rest = u0 * total_weight(terms, eye);
  std::size_t chosen = 0;
  while (chosen + 1 < terms.size()) {
    rest -= weight(terms[chosen], eye);
    if (rest < 0) break;
    ++chosen;
  }
  return terms[chosen].lobe->sample(eye, u1, u2);
}

double pdf(std::span<const Term> terms, const Direction& light, const Direction& eye) {
  const double total = total_weight(terms, eye);
  if (total <= 0) return terms.back().lobe->pdf(light, eye);
  double sum = 0;
  for (const Term& term : terms) sum += weight(term, eye) * term.lobe->pdf(light, eye);
  return sum / total;
}

Colour evaluate(const Brdf& brdf, const Direction& light, const Direction& eye) {
  return evaluate(terms_of(brdf), turned(light, -brdf.rotation), turned(eye, -brdf.rotation));
}

Direction sample(const Brdf& brdf, const Direction& eye, double u0, double u1, double u2) {
  const Direction e = turned(eye, -brdf.rotation);
  return turned(sample(terms_of(brdf), e, u0, u1, u2), brdf.rotation);
}

double pdf(const Brdf& brdf, const Direction& light, const Direction& eye) {
  return pdf(terms_of(brdf), turned(light, -brdf.rotation), turned(eye, -brdf.rotation));
}

// With specular_brdf S and s = (1 - VdotH)^5, Appendix B and the extensions say
//   dielectric = (1 - w max(fr)) base/π + w fr S,  fr = f0 + (1 - f0) s,  w = specular
//   metal      = (base + (1 - base) s) S
// mixed by metallic; sorted here by the four lobes S (1-s), S s, (1-s)/π, s/π.
std::array<Colour, kMaterialLobeCount> material_colours(const MetallicRoughness& material) {
  const double eta = (1 - material.ior) / (1 + material.ior), w = material.specular;
  const auto limited = [&](double colour) { return std::min(1.0, eta * eta * colour); };
  const Colour& specular = material.specular_color;
  const Colour f0(limited(specular.x), limited(specular.y), limited(specular.z));
  const double f0_max = std::max({f0.x, f0.y, f0.z});
  const double metal = material.metallic, dielectric = 1 - metal;
  const Colour base = material.base_color * dielectric;
  return {f0 * (dielectric * w) + material.base_color * metal, Colour(dielectric * w + metal),
          base * (1 - w * f0_max), base * (1 - w)};
}

std::array<LobePointer, kMaterialLobeCount> material_lobes(const MetallicRoughness& material) {
  const double alpha = std::clamp(material.roughness * material.roughness, kMinAlpha, 1.0);
  const double strength = material.has_anisotropy ? material.anisotropy_strength : 0;
  const double alpha_x = alpha + (1 - alpha) * strength * strength;
  const Masking masking = material.has_anisotropy ? Masking::height_correlated : Masking::separable;
  return {ggx(alpha_x, alpha, Fresnel::facing, masking),
          ggx(alpha_x, alpha, Fresnel::grazing, masking), lambert(Fresnel::facing),
          lambert(Fresnel::grazing)};
}

Brdf make_brdf(const MetallicRoughness& material) {
  const auto colours = material_colours(material);
  const auto lobes = material_lobes(material);
  Brdf brdf;
  for (std::size_t i = 0; i < kMaterialLobeCount; ++i) {
    if (colours[i] != Colour(0)) brdf.lobes.push_back({colours[i], lobes[i]});
  }
  if (brdf.lobes.empty()) brdf.lobes.push_back({Colour(0), lambert()});
  brdf.rotation = material.has_anisotropy ? material.anisotropy_rotation : 0;
  return brdf;
}

}  // namespace prt::brdf
