#include "reference/reflector.h"

#include <algorithm>
#include <cassert>

namespace prt::reference {

Reflector::Reflector(brdf::Brdf brdf) : brdf_(std::move(brdf)) {
  assert(!brdf_.lobes.empty() && brdf_.lobes.size() <= brdf::kMaterialLobeCount);
}

Reflector::Reflector(const brdf::MetallicRoughness& material)
    : from_material_(true), material_(material) {
  const auto lobes = brdf::material_lobes(material);
  for (const auto& lobe : lobes) brdf_.lobes.push_back({brdf::Colour(1), lobe});
  brdf_.rotation = material.has_anisotropy ? material.anisotropy_rotation : 0;
}

PointBrdf Reflector::at(const Vec3& albedo) const {
  PointBrdf point;
  if (!from_material_) {
    for (const auto& [colour, lobe] : brdf_.lobes) point.add(colour * brdf::Colour(albedo), *lobe);
    return point;
  }
  brdf::MetallicRoughness material = material_;
  material.base_color = brdf::Colour(albedo);
  const auto colours = brdf::material_colours(material);
  for (std::size_t i = 0; i < colours.size(); ++i) {
    if (colours[i] != brdf::Colour(0)) point.add(colours[i], *brdf_.lobes[i].lobe);
  }
  if (point.terms().empty()) point.add(brdf::Colour(0), *brdf_.lobes.back().lobe);
  return point;
}

bool Reflector::is_isotropic() const {
  return std::all_of(brdf_.lobes.begin(), brdf_.lobes.end(),
                     [](const auto& term) { return term.lobe->is_isotropic(); });
}

}  // namespace prt::reference
