// What the surfaces of one material reflect: the lobes of its BRDF made once, their colours by the
// albedo and the metallic of each point. Where a texture changes the roughness there are lobes for
// every 1/1024 of it.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "brdf/brdf.h"
#include "core/vec.h"
#include "mesh/scene.h"

namespace prt::reference {

/// The BRDF of one point. Its lobes belong to the Reflector.
class PointBrdf {
 public:
  void add(const brdf::Colour& colour, const brdf::Lobe& lobe) {
    terms_[count_++] = {colour, &lobe};
  }
  std::span<const brdf::Term> terms() const { return {terms_.data(), count_}; }

 private:
  std::array<brdf::Term, brdf::kMaterialLobeCount> terms_;
  std::size_t count_ = 0;
};

class Reflector {
 public:
  /// A named BRDF, whose factor is the albedo.
  explicit Reflector(brdf::Brdf brdf);
  /// A material, whose base colour is the albedo.
  explicit Reflector(const mesh::Material& material);

  PointBrdf at(const Vec3& albedo, const mesh::MetallicRoughness& point) const;

  bool is_isotropic() const;
  /// As brdf::Brdf::rotation.
  float rotation() const { return static_cast<float>(brdf_.rotation); }

 private:
  using Lobes = std::array<brdf::LobePointer, brdf::kMaterialLobeCount>;

  brdf::Brdf brdf_;           // with an albedo of 1; of a material its rotation alone
  std::vector<Lobes> lobes_;  // of a material: one, or one for each step of the roughness
  brdf::MetallicRoughness material_;
};

}  // namespace prt::reference
