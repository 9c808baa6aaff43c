#include "brdf/lobe.h"

#include <gtest/gtest.h>

#include <set>

#include "all_lobes.h"
#include "brdf/cubature.h"
#include "brdf/lobe_matrix.h"

namespace prt::brdf {
namespace {

using std::numbers::pi;

const Direction kEyes[] = {from_angles(0, 0), from_angles(0.4, 1), from_angles(1.0, 2.5),
                           from_angles(1.4, -0.6)};

TEST(Lobe, IsReciprocal) {
  for (const auto& lobe : all_lobes()) {
    Pcg32 random(1);
    double sum = 0;
    for (int i = 0; i < 1000; ++i) {
      const Direction a = random_upper(random), b = random_upper(random);
      const double value = lobe->evaluate(a, b);
      ASSERT_GE(value, 0);
      ASSERT_NEAR(lobe->evaluate(b, a), value, 1e-12 * (1 + value)) << lobe->key();
      sum += value;
    }
    EXPECT_GT(sum, 0) << lobe->key();
  }
}

TEST(Lobe, IsZeroBelowTheSurface) {
  const Direction up = from_angles(0.5, 1), down = from_angles(2.5, 1), side(1, 0, 0);
  for (const auto& lobe : all_lobes()) {
    EXPECT_EQ(lobe->evaluate(up, down), 0);
    EXPECT_EQ(lobe->evaluate(down, up), 0);
    EXPECT_EQ(lobe->evaluate(down, down), 0);
    EXPECT_EQ(lobe->evaluate(side, up), 0);
  }
}

// What the matrix's quadrature rests on.
TEST(Lobe, HasTheSymmetriesPromised) {
  for (const auto& lobe : all_lobes()) {
    Pcg32 random(2);
    for (int i = 0; i < 100; ++i) {
      const Direction a = random_upper(random), b = random_upper(random);
      const double value = lobe->evaluate(a, b), tolerance = 1e-9 * (1 + value);
      const auto in_x = [](const Direction& w) { return Direction(-w.x, w.y, w.z); };
      const auto in_y = [](const Direction& w) { return Direction(w.x, -w.y, w.z); };
      ASSERT_NEAR(lobe->evaluate(in_x(a), in_x(b)), value, tolerance) << lobe->key();
      ASSERT_NEAR(lobe->evaluate(in_y(a), in_y(b)), value, tolerance) << lobe->key();
      const auto turned = [](const Direction& w) {
        return Direction(0.6 * w.x - 0.8 * w.y, 0.8 * w.x + 0.6 * w.y, w.z);
      };
      if (lobe->is_isotropic()) {
        ASSERT_NEAR(lobe->evaluate(turned(a), turned(b)), value, tolerance) << lobe->key();
      }
    }
  }
}

TEST(Lobe, ReflectsNoMoreThanItReceives) {
  for (const auto& lobe : all_lobes()) {
    for (double theta = 0; theta < pi / 2; theta += 0.13) {
      for (double phi : {0.0, 0.7, pi / 2}) {
        const double albedo = directional_albedo(*lobe, from_angles(theta, phi), 1e-5);
        EXPECT_LE(albedo, 1 + 1e-5) << lobe->key() << " at " << theta;
        EXPECT_GT(albedo, 0) << lobe->key() << " at " << theta;
      }
    }
  }
}

TEST(Lobe, AlbedosHaveClosedForms) {
  const Direction normal(0, 0, 1), oblique = from_angles(0.9, 0.3);
  EXPECT_NEAR(directional_albedo(*lambert(), oblique), 1, 1e-6);
  // ∫ (1-cos)^5 of the half angle θ/2 along the normal: 2 ∫ (1-t)^5 4t(2t²-1) dt over [√½, 1].
  const auto grazing = [](double t) { return std::pow(1 - t, 5) * 8 * t * (2 * t * t - 1); };
  double sum = 0;
  const int n = 20000;
  const double low = std::sqrt(0.5);
  for (int i = 0; i < n; ++i) sum += grazing(low + (1 - low) * (i + 0.5) / n) * (1 - low) / n;
  EXPECT_NEAR(directional_albedo(*lambert(Fresnel::grazing), normal), sum, 1e-6);
  EXPECT_NEAR(directional_albedo(*phong(10), normal), 1, 1e-6);
  EXPECT_NEAR(directional_albedo(*phong(200), normal), 1, 1e-6);
  // 28/(23π) (1 - 1/32) 2π ∫ (1 - (1-z/2)^5) z dz
  double diffuse = 0;
  for (int i = 0; i < n; ++i) {
    const double z = (i + 0.5) / n;
    diffuse += (1 - std::pow(1 - z / 2, 5)) * z / n;
  }
  EXPECT_NEAR(directional_albedo(*ashikhmin_shirley_diffuse(), normal),
              56.0 / 23 * (31.0 / 32) * diffuse, 1e-6);
}

TEST(Lobe, FresnelPartsAddUpToTheWhole) {
  Pcg32 random(3);
  for (int i = 0; i < 100; ++i) {
    const Direction a = random_upper(random), b = random_upper(random);
    const auto sum = [&](const auto& make) {
      EXPECT_NEAR(make(Fresnel::facing)->evaluate(a, b) + make(Fresnel::grazing)->evaluate(a, b),
                  make(Fresnel::one)->evaluate(a, b), 1e-12);
    };
    sum([](Fresnel fresnel) { return lambert(fresnel); });
    sum([](Fresnel fresnel) { return ggx(0.4, 0.9, fresnel); });
    sum([](Fresnel fresnel) { return ashikhmin_shirley(3, 7, fresnel); });
  }
}

// Values worked out by hand from the published formulas.
TEST(Lobe, MatchesTheFormulasAtAPoint) {
  const Direction eye(0.6, 0, 0.8), light(-0.6, 0, 0.8);  // h is the normal, eye·h = 0.8
  EXPECT_NEAR(phong(10)->evaluate(light, eye), 12 / (2 * pi), 1e-12);
  const double a2 = 0.25 * 0.25;
  const double g1 = 2 * 0.8 / (0.8 + std::sqrt(a2 + (1 - a2) * 0.64));
  EXPECT_NEAR(ggx(0.25, 0.25)->evaluate(light, eye), g1 * g1 / (pi * a2) / (4 * 0.64), 1e-12);
  const double length = std::hypot(0.5 * 0.6, 0.8);
  EXPECT_NEAR(ggx(0.5, 0.25, Fresnel::one, Masking::height_correlated)->evaluate(light, eye),
              1 / (pi * 0.125) * 0.5 / (2 * 0.8 * length), 1e-12);
  EXPECT_NEAR(ward(0.2, 0.4)->evaluate(light, eye), 1 / (4 * pi * 0.08 * 0.64), 1e-12);
  EXPECT_NEAR(ashikhmin_shirley(8, 3)->evaluate(light, eye), 6 / (8 * pi * 0.64), 1e-12);
  // Off the mirror direction: h = (0.6, 0, 0.8) for light along the eye.
  EXPECT_NEAR(ward(0.5, 0.4)->evaluate(eye, eye),
              std::exp(-std::pow(0.75 / 0.5, 2)) / (4 * pi * 0.2 * std::pow(0.8, 4)), 1e-12);
  const double d = 1 / (pi * 0.125 * std::pow(0.36 / 0.25 + 0.64, 2));
  EXPECT_NEAR(ggx(0.5, 0.25)->evaluate(eye, eye), d / std::pow(0.8 + length, 2), 1e-12);
  EXPECT_NEAR(ashikhmin_shirley(8, 3)->evaluate(eye, eye), 6 / (8 * pi) * std::pow(0.8, 8) / 0.8,
              1e-12);
}

TEST(Lobe, DensityIntegratesToOneOverTheSphere) {
  for (const auto& lobe : all_lobes()) {
    for (const Direction& eye : kEyes) {
      const double theta = std::acos(eye.z), phi = std::atan2(-eye.y, -eye.x);
      // Cut at the eye's angle and where half vectors end.
      std::vector<Box> sphere;
      for (const auto& [low, high] :
           {std::pair(0.0, theta), {theta, pi - theta}, {pi - theta, pi}}) {
        if (low == high) continue;
        sphere.push_back({low, high, phi - pi, phi});
        sphere.push_back({low, high, phi, phi + pi});
      }
      const Integrand density = [&](std::span<const Point> points, std::span<double> values) {
        for (std::size_t i = 0; i < points.size(); ++i) {
          const Direction light = from_angles(points[i].x, points[i].y);
          values[i] = lobe->pdf(light, eye) * std::sin(points[i].x);
        }
      };
      const auto result = integrate(sphere, density, {.tolerance = 1e-5});
      EXPECT_NEAR(result.values[0], 1, 2e-4) << lobe->key() << " at " << theta;
    }
  }
}

// χ² over 8 × 16 cells of the sphere, equal in area, against the density's integral over each.
TEST(Lobe, SamplesHaveTheirDensity) {
  constexpr int kRows = 8, kColumns = 16, kSampleCount = 40000;
  for (const auto& lobe : all_lobes()) {
    for (const Direction& eye : kEyes) {
      Pcg32 random(4);
      std::vector<double> counts(kRows * kColumns);
      for (int i = 0; i < kSampleCount; ++i) {
        const double u1 = random.uniform(), u2 = random.uniform();
        const Direction w = lobe->sample(eye, u1, u2);
        ASSERT_NEAR(w.length(), 1, 1e-9);
        const double phi = std::atan2(w.y, w.x) + pi;
        const int row = std::min(kRows - 1, static_cast<int>((1 - w.z) / 2 * kRows));
        const int column = std::min(kColumns - 1, static_cast<int>(phi / (2 * pi) * kColumns));
        counts[static_cast<std::size_t>(row * kColumns + column)] += 1;
      }
      double chi2 = 0, pooled_expected = 0, pooled_count = 0;
      int cell_count = 0;
      for (int cell = 0; cell < kRows * kColumns; ++cell) {
        const double z = 1 - 2.0 * (cell / kColumns) / kRows, width = 2 * pi / kColumns;
        const double phi = (cell % kColumns) * width - pi;
        const Box box{z - 2.0 / kRows, z, phi, phi + width};
        const Integrand density = [&](std::span<const Point> points, std::span<double> values) {
          for (std::size_t i = 0; i < points.size(); ++i) {
            values[i] = lobe->pdf(from_angles(std::acos(points[i].x), points[i].y), eye);
          }
        };
        const double expected =
            kSampleCount * integrate({&box, 1}, density, {.tolerance = 1e-6}).values[0];
        const double count = counts[static_cast<std::size_t>(cell)];
        if (expected < 5) {
          pooled_expected += expected, pooled_count += count;
        } else {
          chi2 += (count - expected) * (count - expected) / expected;
          ++cell_count;
        }
      }
      if (pooled_expected >= 5) {
        chi2 += std::pow(pooled_count - pooled_expected, 2) / pooled_expected;
        ++cell_count;
      } else {
        EXPECT_LE(pooled_count, 25) << lobe->key();
      }
      // Mean k-1, variance 2(k-1): five standard deviations.
      const double freedom = std::max(1, cell_count - 1);
      EXPECT_LT(chi2, freedom + 5 * std::sqrt(2 * freedom)) << lobe->key() << " eye " << eye;
    }
  }
}

// The furnace: under constant unit radiance the sampler's estimate is the albedo.
TEST(Lobe, SamplingGivesTheAlbedo) {
  for (const auto& lobe : all_lobes()) {
    for (const Direction& eye : kEyes) {
      Pcg32 random(5);
      double sum = 0, squares = 0;
      const int count = 20000;
      for (int i = 0; i < count; ++i) {
        const double u1 = random.uniform(), u2 = random.uniform();
        const Direction light = lobe->sample(eye, u1, u2);
        const double value = lobe->evaluate(light, eye);
        const double term = value > 0 ? value * light.z / lobe->pdf(light, eye) : 0;
        sum += term, squares += term * term;
      }
      const double mean = sum / count, deviation = std::sqrt(squares / count - mean * mean);
      EXPECT_NEAR(mean, directional_albedo(*lobe, eye, 1e-5),
                  5 * deviation / std::sqrt(count) + 2e-5)
          << lobe->key();
    }
  }
}

TEST(Lobe, KeysTellLobesApart) {
  std::set<std::string> keys;
  for (const auto& lobe : all_lobes()) keys.insert(lobe->key());
  EXPECT_EQ(keys.size(), all_lobes().size());
  EXPECT_EQ(ggx(0.3, 0.4)->key(), ggx(0.3, 0.4)->key());
  EXPECT_NE(ggx(0.3, 0.4)->key(), ggx(0.3, std::nextafter(0.4, 1))->key());
}

}  // namespace
}  // namespace prt::brdf
