// What the surfaces of one material reflect: the lobes of its BRDF once, their colours by the
// albedo of each point.
#pragma once

#include <array>
#include <span>

#include "brdf/brdf.h"
#include "core/vec.h"

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
  explicit Reflector(const brdf::MetallicRoughness& material);

  PointBrdf at(const Vec3& albedo) const;

  bool is_isotropic() const;
  /// As brdf::Brdf::rotation.
  float rotation() const { return static_cast<float>(brdf_.rotation); }

 private:
  brdf::Brdf brdf_;  // with an albedo of 1
  bool from_material_ = false;
  brdf::MetallicRoughness material_;
};

}  // namespace prt::reference
