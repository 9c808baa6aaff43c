#include <fmt/format.h>

#include "brdf/half_vector.h"

namespace prt::brdf {

double Lobe::importance(const Direction&) const { return 1; }

namespace {

class CosineSampled : public Lobe {
 public:
  Direction sample(const Direction&, double u1, double u2) const override {
    return sample_cosine(u1, u2);
  }
  double pdf(const Direction& light, const Direction&) const override {
    return std::max(light.z, 0.0) / kPi;
  }
};

class Lambert final : public CosineSampled {
 public:
  explicit Lambert(Fresnel fresnel) : fresnel_(fresnel) {}

  std::string key() const override { return fmt::format("lambert {}", name_of(fresnel_)); }

  double evaluate(const Direction& light, const Direction& eye) const override {
    if (!above(light, eye)) return 0;
    if (fresnel_ == Fresnel::one) return 1 / kPi;
    return schlick(fresnel_, half_vector(light, eye) ^ eye) / kPi;
  }

  double importance(const Direction& eye) const override { return schlick(fresnel_, eye.z); }

 private:
  Fresnel fresnel_;
};

class AshikhminShirleyDiffuse final : public CosineSampled {
 public:
  std::string key() const override { return "ashikhmin-shirley-diffuse"; }

  double evaluate(const Direction& light, const Direction& eye) const override {
    if (!above(light, eye)) return 0;
    return 28 / (23 * kPi) * (1 - std::pow(1 - light.z / 2, 5)) * (1 - std::pow(1 - eye.z / 2, 5));
  }
};

}  // namespace

LobePointer lambert(Fresnel fresnel) { return std::make_shared<Lambert>(fresnel); }
LobePointer ashikhmin_shirley_diffuse() { return std::make_shared<AshikhminShirleyDiffuse>(); }

}  // namespace prt::brdf
