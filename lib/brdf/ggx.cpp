#include <fmt/format.h>

#include <cassert>

#include "brdf/half_vector.h"

namespace prt::brdf {

namespace {

// D(h) = 1 / (π αx αy ((x/αx)² + (y/αy)² + z²)²). Smith's G1(w) = 2 z / (z + |stretched w|), where
// stretching multiplies x and y by alpha; G / (4 light.z eye.z) loses its denominator below.
class Ggx final : public Lobe {
 public:
  Ggx(double alpha_x, double alpha_y, Fresnel fresnel, Masking masking)
      : alpha_x_(alpha_x), alpha_y_(alpha_y), fresnel_(fresnel), masking_(masking) {
    assert(std::min(alpha_x, alpha_y) >= kMinAlpha && std::max(alpha_x, alpha_y) <= 1);
  }

  std::string key() const override {
    return fmt::format("ggx {:a} {:a} {} {}", alpha_x_, alpha_y_, name_of(fresnel_),
                       masking_ == Masking::separable ? "separable" : "height-correlated");
  }

  double evaluate(const Direction& light, const Direction& eye) const override {
    if (!above(light, eye)) return 0;
    const Direction h = half_vector(light, eye);
    return schlick(fresnel_, h ^ eye) * distribution(h) * visibility(light, eye);
  }

  // [Heitz 2018]: the hemisphere that the eye sees of a stretched sphere is a disk cut in two.
  Direction sample(const Direction& eye, double u1, double u2) const override {
    const Direction view = stretched(eye).normalized();
    const double length = std::hypot(view.x, view.y);
    const Direction t1 =
        length > 0 ? Direction(-view.y / length, view.x / length, 0) : Direction(1, 0, 0);
    const Direction t2 = view % t1;
    const double r = std::sqrt(u1), phi = 2 * kPi * u2;
    const double p1 = r * std::cos(phi), s = (1 + view.z) / 2;
    const double p2 = (1 - s) * std::sqrt(1 - p1 * p1) + s * r * std::sin(phi);
    const double p3 = std::sqrt(std::max(0.0, 1 - p1 * p1 - p2 * p2));
    const Direction normal = t1 * p1 + t2 * p2 + view * p3;
    const Direction h(alpha_x_ * normal.x, alpha_y_ * normal.y, std::max(0.0, normal.z));
    return mirror(eye, h.normalized());
  }

  // G1(eye) D(h) (eye·h) / eye.z over half vectors, / (4 eye·h) over directions.
  double pdf(const Direction& light, const Direction& eye) const override {
    const Direction sum = light + eye;
    if (sum.z <= 0) return 0;
    return distribution(sum.normalized()) / (2 * (eye.z + stretched(eye).length()));
  }

  double importance(const Direction& eye) const override { return schlick(fresnel_, eye.z); }
  bool is_isotropic() const override { return alpha_x_ == alpha_y_; }
  double width() const override { return std::min(1.0, 2 * std::min(alpha_x_, alpha_y_)); }
  std::optional<Imath::V2d> slope_scale() const override { return Imath::V2d(alpha_x_, alpha_y_); }

 private:
  Direction stretched(const Direction& w) const { return {alpha_x_ * w.x, alpha_y_ * w.y, w.z}; }

  double distribution(const Direction& h) const {
    const double x = h.x / alpha_x_, y = h.y / alpha_y_;
    const double square = x * x + y * y + h.z * h.z;
    return 1 / (kPi * alpha_x_ * alpha_y_ * square * square);
  }

  double visibility(const Direction& light, const Direction& eye) const {
    const double a = stretched(light).length(), b = stretched(eye).length();
    if (masking_ == Masking::separable) return 1 / ((light.z + a) * (eye.z + b));
    return 0.5 / (eye.z * a + light.z * b);
  }

  double alpha_x_, alpha_y_;
  Fresnel fresnel_;
  Masking masking_;
};

}  // namespace

LobePointer ggx(double alpha_x, double alpha_y, Fresnel fresnel, Masking masking) {
  return std::make_shared<Ggx>(alpha_x, alpha_y, fresnel, masking);
}

}  // namespace prt::brdf
