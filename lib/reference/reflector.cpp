#include "reference/reflector.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "brdf/scene_material.h"

namespace prt::reference {

namespace {
constexpr int kRoughnessSteps = 1024;
}

Reflector::Reflector(brdf::Brdf brdf) : brdf_(std::move(brdf)) {
  assert(!brdf_.lobes.empty() && brdf_.lobes.size() <= brdf::kMaterialLobeCount);
}

Reflector::Reflector(const mesh::Material& material)
    : material_(brdf::metallic_roughness(material)) {
  brdf_.rotation = material_.has_anisotropy ? material_.anisotropy_rotation : 0;
  if (material.metallic_roughness_image < 0) {
    lobes_.push_back(brdf::material_lobes(material_));
    return;
  }
  brdf::MetallicRoughness step = material_;
  for (int i = 0; i <= kRoughnessSteps; ++i) {
    step.roughness = static_cast<double>(i) / kRoughnessSteps;
    lobes_.push_back(brdf::material_lobes(step));
  }
}

PointBrdf Reflector::at(const Vec3& albedo, const mesh::MetallicRoughness& point) const {
  PointBrdf result;
  for (const auto& [colour, lobe] : brdf_.lobes) result.add(colour * brdf::Colour(albedo), *lobe);
  if (lobes_.empty()) return result;
  brdf::MetallicRoughness material = material_;
  material.base_color = brdf::Colour(albedo);
  material.metallic = double{point.metallic};
  const auto colours = brdf::material_colours(material);
  const auto step = static_cast<std::size_t>(std::lround(point.roughness * kRoughnessSteps));
  const Lobes& lobes = lobes_[lobes_.size() == 1 ? 0 : step];
  for (std::size_t i = 0; i < colours.size(); ++i) {
    if (colours[i] != brdf::Colour(0)) result.add(colours[i], *lobes[i]);
  }
  if (result.terms().empty()) result.add(brdf::Colour(0), *lobes.back());
  return result;
}

bool Reflector::is_isotropic() const {
  const auto isotropic = [](const brdf::LobePointer& lobe) { return lobe->is_isotropic(); };
  return std::all_of(brdf_.lobes.begin(), brdf_.lobes.end(),
                     [&](const auto& term) { return isotropic(term.lobe); }) &&
         std::all_of(lobes_.begin(), lobes_.end(), [&](const Lobes& lobes) {
           return std::all_of(lobes.begin(), lobes.end(), isotropic);
         });
}

}  // namespace prt::reference
