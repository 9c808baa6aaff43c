#include <fmt/format.h>

#include <cassert>

#include "brdf/half_vector.h"

namespace prt::brdf {

namespace {

class Ward final : public Lobe {
 public:
  Ward(double alpha_x, double alpha_y) : alpha_x_(alpha_x), alpha_y_(alpha_y) {
    assert(std::min(alpha_x, alpha_y) >= kMinAlpha && std::max(alpha_x, alpha_y) <= 1);
  }

  std::string key() const override { return fmt::format("ward {:a} {:a}", alpha_x_, alpha_y_); }

  double evaluate(const Direction& light, const Direction& eye) const override {
    if (!above(light, eye)) return 0;
    const Direction h = half_vector(light, eye);
    const double cosine = h ^ eye, z2 = h.z * h.z;
    return gaussian(h) / (4 * cosine * cosine * z2 * z2);
  }

  Direction sample(const Direction& eye, double u1, double u2) const override {
    const double radius = std::sqrt(-std::log(1 - u1)), phi = 2 * kPi * u2;
    const Direction slope(alpha_x_ * radius * std::cos(phi), alpha_y_ * radius * std::sin(phi), 1);
    return mirror(eye, slope.normalized());
  }

  // Slopes are Gaussian; dslope = dh / z³, dh = dlight / (4 eye·h).
  double pdf(const Direction& light, const Direction& eye) const override {
    const Direction h = half_vector(light, eye);
    if (h.z <= 0) return 0;
    return gaussian(h) / (h.z * h.z * h.z * 4 * std::abs(h ^ eye));
  }

  bool is_isotropic() const override { return alpha_x_ == alpha_y_; }
  double width() const override { return std::min(1.0, 2 * std::min(alpha_x_, alpha_y_)); }
  std::optional<Imath::V2d> slope_scale() const override { return Imath::V2d(alpha_x_, alpha_y_); }

 private:
  double gaussian(const Direction& h) const {
    const double x = h.x / (alpha_x_ * h.z), y = h.y / (alpha_y_ * h.z);
    return std::exp(-(x * x + y * y)) / (kPi * alpha_x_ * alpha_y_);
  }

  double alpha_x_, alpha_y_;
};

}  // namespace

LobePointer ward(double alpha_x, double alpha_y) {
  return std::make_shared<Ward>(alpha_x, alpha_y);
}

}  // namespace prt::brdf
