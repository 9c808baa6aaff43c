#include <fmt/format.h>

#include <cassert>

#include "brdf/half_vector.h"

namespace prt::brdf {

namespace {

class Phong final : public Lobe {
 public:
  explicit Phong(double exponent) : exponent_(exponent) { assert(exponent >= 1); }

  std::string key() const override { return fmt::format("phong {:a}", exponent_); }

  double evaluate(const Direction& light, const Direction& eye) const override {
    if (!above(light, eye)) return 0;
    return (exponent_ + 2) / (2 * kPi) * power_cosine(light, eye);
  }

  // cos^N about the mirrored eye, in any frame about it.
  Direction sample(const Direction& eye, double u1, double u2) const override {
    const Direction z(-eye.x, -eye.y, eye.z);
    const Direction x =
        (std::abs(z.x) < 0.5 ? Direction(1, 0, 0) % z : Direction(0, 1, 0) % z).normalized();
    const double cosine = std::pow(1 - u1, 1 / (exponent_ + 1));
    const double sine = std::sqrt(1 - cosine * cosine), phi = 2 * kPi * u2;
    return x * (sine * std::cos(phi)) + (z % x) * (sine * std::sin(phi)) + z * cosine;
  }

  double pdf(const Direction& light, const Direction& eye) const override {
    return (exponent_ + 1) / (2 * kPi) * power_cosine(light, eye);
  }

  double width() const override { return std::min(1.0, std::sqrt(2 / (exponent_ + 1))); }

 private:
  double power_cosine(const Direction& light, const Direction& eye) const {
    const double cosine = light.z * eye.z - light.x * eye.x - light.y * eye.y;
    return cosine > 0 ? std::pow(cosine, exponent_) : 0;
  }

  double exponent_;
};

}  // namespace

LobePointer phong(double exponent) { return std::make_shared<Phong>(exponent); }

}  // namespace prt::brdf
