#include <fmt/format.h>

#include <cassert>

#include "brdf/half_vector.h"

namespace prt::brdf {

namespace {

class AshikhminShirley final : public Lobe {
 public:
  AshikhminShirley(double n_u, double n_v, Fresnel fresnel)
      : n_u_(n_u), n_v_(n_v), fresnel_(fresnel) {
    assert(n_u >= 0 && n_v >= 0);
  }

  std::string key() const override {
    return fmt::format("ashikhmin-shirley {:a} {:a} {}", n_u_, n_v_, name_of(fresnel_));
  }

  double evaluate(const Direction& light, const Direction& eye) const override {
    if (!above(light, eye)) return 0;
    const Direction h = half_vector(light, eye);
    const double cosine = h ^ eye;
    return half_pdf(h) * schlick(fresnel_, cosine) / (4 * cosine * std::max(light.z, eye.z));
  }

  Direction sample(const Direction& eye, double u1, double u2) const override {
    const double psi = 2 * kPi * u2;
    const double phi =
        std::atan2(std::sqrt(n_u_ + 1) * std::sin(psi), std::sqrt(n_v_ + 1) * std::cos(psi));
    const double c = std::cos(phi), s = std::sin(phi);
    const double z = std::pow(1 - u1, 1 / (n_u_ * c * c + n_v_ * s * s + 1));
    const double r = std::sqrt(1 - z * z);
    return mirror(eye, {r * c, r * s, z});
  }

  double pdf(const Direction& light, const Direction& eye) const override {
    const Direction h = half_vector(light, eye);
    if (h.z <= 0) return 0;
    return half_pdf(h) / (4 * std::abs(h ^ eye));
  }

  double importance(const Direction& eye) const override { return schlick(fresnel_, eye.z); }
  bool is_isotropic() const override { return n_u_ == n_v_; }
  double width() const override {
    return std::min(1.0, 2 * std::sqrt(2 / (std::max(n_u_, n_v_) + 1)));
  }

 private:
  /// Density of half vectors.
  double half_pdf(const Direction& h) const {
    const double r2 = h.x * h.x + h.y * h.y;
    const double exponent = r2 > 0 ? (n_u_ * h.x * h.x + n_v_ * h.y * h.y) / r2 : 0;
    return std::sqrt((n_u_ + 1) * (n_v_ + 1)) / (2 * kPi) * std::pow(h.z, exponent);
  }

  double n_u_, n_v_;
  Fresnel fresnel_;
};

}  // namespace

LobePointer ashikhmin_shirley(double n_u, double n_v, Fresnel fresnel) {
  return std::make_shared<AshikhminShirley>(n_u, n_v, fresnel);
}

}  // namespace prt::brdf
