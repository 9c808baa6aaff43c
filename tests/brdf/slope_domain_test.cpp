#include "brdf/slope_domain.h"

#include <gtest/gtest.h>

#include <atomic>

#include "all_lobes.h"
#include "brdf/lobe_matrix.h"
#include "sh/basis.h"
#include "sh/quadrature.h"

namespace prt::brdf {
namespace {

using std::numbers::pi;

/// Evaluations are what a quadrature costs, on any machine.
class Counted final : public Lobe {
 public:
  explicit Counted(LobePointer lobe) : lobe_(std::move(lobe)) {}
  std::string key() const override { return lobe_->key(); }
  double evaluate(const Direction& light, const Direction& eye) const override {
    ++count;
    return lobe_->evaluate(light, eye);
  }
  Direction sample(const Direction& eye, double u1, double u2) const override {
    return lobe_->sample(eye, u1, u2);
  }
  double pdf(const Direction& light, const Direction& eye) const override {
    return lobe_->pdf(light, eye);
  }
  bool is_isotropic() const override { return lobe_->is_isotropic(); }
  double width() const override { return lobe_->width(); }
  std::optional<Imath::V2d> slope_scale() const override { return lobe_->slope_scale(); }

  mutable std::atomic<std::size_t> count{0};

 private:
  LobePointer lobe_;
};

// All that the eye sees reflected, and nothing else, once: the hemisphere.
TEST(SlopeDomain, IsTheHemisphereAboveTheHorizon) {
  const sh::GaussLegendre rule(60);
  for (const Imath::V2d& scale : {Imath::V2d(1, 1), Imath::V2d(0.5, 0.2), Imath::V2d(0.3, 1)}) {
    for (const double theta : {0.0, 0.8, 1.4}) {
      const SlopeDomain domain(scale, from_angles(theta, 0.6));
      double area = 0, moment = 0;
      for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
        const auto chord = domain.chord(rule.nodes[i] * pi / 2);
        for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
          const auto [light, density] = chord.at((rule.nodes[j] + 1) / 2);
          const double weight = rule.weights[i] * rule.weights[j] * pi / 4 * density;
          EXPECT_GT(light.z, -1e-9);
          area += weight;
          moment += weight * light.z * (1 + light.x * light.x);
        }
      }
      EXPECT_NEAR(area, 2 * pi, 2e-4) << scale << theta;
      EXPECT_NEAR(moment, pi + pi / 4, 2e-4) << scale << theta;
    }
  }
}

// Against the midpoint rule over what the lobe's own sampler makes of a square.
TEST(LobeMoments, OfSharpAnisotropicLobesMatchTheirSamplers) {
  constexpr int kCount = 700, kBands = 4;
  std::vector<double> basis(kBands * kBands);
  for (const auto& lobe :
       {ggx(0.25, 0.001), ggx(0.002, 1, Fresnel::facing, Masking::height_correlated),
        ward(0.01, 0.4)}) {
    for (const double theta : {0.4, 1.5}) {
      const Direction eye = from_angles(theta, 1.1);
      std::vector<double> expected(basis.size());
      for (int k = 0; k < kCount * kCount; ++k) {
        const double u1 = (k / kCount + 0.5) / kCount, u2 = (k % kCount + 0.5) / kCount;
        const Direction light = lobe->sample(eye, u1, u2);
        const double value = lobe->evaluate(light, eye);
        if (value == 0) continue;
        sh::evaluate(kBands, light.x, light.y, light.z, basis);
        const double weight = value * light.z / lobe->pdf(light, eye) / (kCount * kCount);
        for (std::size_t j = 0; j < basis.size(); ++j) expected[j] += weight * basis[j];
      }
      const LobeMoments moments = lobe_moments(*lobe, eye, kBands, 1e-6);
      EXPECT_LE(moments.error, 1e-6) << lobe->key();
      for (std::size_t j = 0; j < basis.size(); ++j) {
        EXPECT_NEAR(moments.values[j], expected[j], 2e-5) << lobe->key() << theta << " " << j;
      }
    }
  }
}

// In polar angles this took a hundred times as many evaluations, and was wrong.
TEST(LobeMatrix, OfASharpAnisotropicLobeIsFoundQuickly) {
  const Counted lobe(ggx(0.25, 0.001));
  const LobeMatrix matrix = compute_lobe_matrix(lobe, 3, 3, 1e-3);
  EXPECT_LE(matrix.error, 1e-3);
  EXPECT_LT(lobe.count, 12000000u);
  EXPECT_GT(lobe.count, 0u);
}

}  // namespace
}  // namespace prt::brdf
