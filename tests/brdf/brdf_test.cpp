#include "brdf/brdf.h"

#include <gtest/gtest.h>

#include "all_lobes.h"
#include "brdf/cubature.h"
#include "brdf/lobe_matrix.h"
#include "core/error.h"

namespace prt::brdf {
namespace {

using std::numbers::pi;

std::vector<MetallicRoughness> materials() {
  MetallicRoughness metal{.base_color = {0.9, 0.6, 0.2}, .roughness = 0.4};
  MetallicRoughness plastic{.base_color = {0.2, 0.5, 0.8}, .metallic = 0, .roughness = 0.6};
  MetallicRoughness mixed{.base_color = {0.2, 0.5, 0.8},
                          .metallic = 0.3,
                          .roughness = 0.5,
                          .ior = 1.8,
                          .specular = 0.7,
                          .specular_color = {1, 0.5, 2}};
  MetallicRoughness brushed{.base_color = {0.9, 0.9, 0.9},
                            .roughness = 0.3,
                            .has_anisotropy = true,
                            .anisotropy_strength = 0.8,
                            .anisotropy_rotation = 0.6};
  return {metal, plastic, mixed, brushed};
}

Colour albedo(const Brdf& brdf, const Direction& eye) {
  Colour sum(0);
  const double c = std::cos(-brdf.rotation), s = std::sin(-brdf.rotation);
  const Direction turned(c * eye.x - s * eye.y, s * eye.x + c * eye.y, eye.z);
  for (const auto& [colour, lobe] : brdf.lobes) {
    sum += colour * directional_albedo(*lobe, turned, 1e-6);
  }
  return sum;
}

// The formulas of the specification, written out as it has them.
Colour appendix_b(const MetallicRoughness& material, const Direction& l, const Direction& v) {
  const Direction h = (l + v).normalized();
  const double s = std::pow(1 - (v ^ h), 5), a2 = std::pow(material.roughness, 4);
  const double f = h.z * h.z * (a2 - 1) + 1, d = a2 / (pi * f * f);
  const auto g1 = [&](double z) { return 2 * z / (z + std::sqrt(a2 + (1 - a2) * z * z)); };
  const double specular_brdf = d * g1(l.z) * g1(v.z) / (4 * l.z * v.z);
  const double f0 = std::pow((1 - material.ior) / (1 + material.ior), 2);
  Colour fr;
  double fr_max = 0;
  for (int c = 0; c < 3; ++c) {
    const double f0_c = std::min(f0 * material.specular_color[c], 1.0);
    fr[c] = f0_c + (1 - f0_c) * s;
    fr_max = std::max(fr_max, fr[c]);
  }
  const Colour dielectric = material.base_color / pi * (1 - material.specular * fr_max) +
                            fr * (material.specular * specular_brdf);
  const Colour metal =
      (material.base_color + (Colour(1) - material.base_color) * s) * specular_brdf;
  return dielectric * (1 - material.metallic) + metal * material.metallic;
}

TEST(Brdf, MetallicRoughnessIsAppendixB) {
  for (const MetallicRoughness& material : materials()) {
    if (material.has_anisotropy) continue;
    const Brdf brdf = make_brdf(material);
    Pcg32 random(7);
    for (int i = 0; i < 200; ++i) {
      const Direction l = random_upper(random), v = random_upper(random);
      const Colour expected = appendix_b(material, l, v), found = evaluate(brdf, l, v);
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(found[c], expected[c], 1e-9 * (1 + expected[c]));
    }
  }
}

// The formulas of KHR_materials_anisotropy, the tangent turned by hand.
TEST(Brdf, AnisotropyIsTheExtensions) {
  const MetallicRoughness material = materials().back();
  const Brdf brdf = make_brdf(material);
  const double ab = 0.09, at = ab + (1 - ab) * 0.64;
  const Direction t(std::cos(0.6), std::sin(0.6), 0), b(-std::sin(0.6), std::cos(0.6), 0);
  Pcg32 random(8);
  for (int i = 0; i < 200; ++i) {
    const Direction l = random_upper(random), v = random_upper(random), h = (l + v).normalized();
    const double a2 = at * ab;
    const Direction f(ab * (t ^ h), at * (b ^ h), a2 * h.z);
    const double w2 = a2 / f.length2(), d = a2 * w2 * w2 / pi;
    const double ggx_v = l.z * Direction(at * (t ^ v), ab * (b ^ v), v.z).length();
    const double ggx_l = v.z * Direction(at * (t ^ l), ab * (b ^ l), l.z).length();
    const double fresnel = 0.9 + 0.1 * std::pow(1 - (v ^ h), 5);
    const double expected = fresnel * d * 0.5 / (ggx_v + ggx_l);
    ASSERT_NEAR(evaluate(brdf, l, v).x, expected, 1e-9 * (1 + expected));
  }
}

TEST(Brdf, ExtremeMaterialsAreWellDefined) {
  const Direction eye = from_angles(0.3, 0), mirror = from_angles(0.3, pi);
  const Brdf smooth = make_brdf({.roughness = 0});
  EXPECT_TRUE(std::isfinite(evaluate(smooth, mirror, eye).x));
  EXPECT_NEAR(albedo(smooth, eye).x, 1, 1e-4);
  const Brdf infinite_ior = make_brdf({.metallic = 0, .roughness = 0.5, .ior = 0});
  EXPECT_EQ(infinite_ior.lobes[0].colour, Colour(1));
  const Brdf black = make_brdf({.base_color = {0, 0, 0}, .metallic = 0, .specular = 0});
  EXPECT_EQ(evaluate(black, mirror, eye), Colour(0));
  EXPECT_GT(pdf(black, sample(black, eye, 0.5, 0.5, 0.5), eye), 0);
  const Brdf diffuse = make_brdf({.metallic = 0, .specular = 0});
  EXPECT_NEAR(evaluate(diffuse, mirror, eye).x, 1 / pi, 1e-12);
}

TEST(Brdf, MetalsReflectNoMoreThanTheyReceive) {
  for (double roughness : {0.1, 0.4, 1.0}) {
    for (const bool anisotropic : {false, true}) {
      const Brdf white = make_brdf(
          {.roughness = roughness, .has_anisotropy = anisotropic, .anisotropy_strength = 0.7});
      for (double theta = 0.05; theta < pi / 2; theta += 0.2) {
        EXPECT_LE(albedo(white, from_angles(theta, 0.4)).x, 1 + 1e-5) << roughness;
      }
    }
  }
}

// The specification says of its coupling of diffuse and specular that it does not conserve energy:
// up to 60 degrees it is off by 3% at most, beyond by 41%, for light from all sides by 4%.
TEST(Brdf, WhiteDielectricsReflectTooMuchOnlyAtGrazingAngles) {
  for (double roughness : {0.2, 0.5, 1.0}) {
    const Brdf white = make_brdf({.metallic = 0, .roughness = roughness});
    double mean = 0, worst = 0;
    constexpr int kCount = 40;
    for (int i = 0; i < kCount; ++i) {
      const double z = std::sqrt((i + 0.5) / kCount);  // equal shares of the projected hemisphere
      const double share = albedo(white, from_angles(std::acos(z), 0)).x;
      mean += share / kCount;
      worst = std::max(worst, share);
      if (z > 0.5) {
        EXPECT_LE(share, 1.03) << roughness << " at " << z;
      }
    }
    EXPECT_LE(mean, 1.04) << roughness;
    EXPECT_LE(worst, 1.42) << roughness;
  }
}

TEST(Brdf, IsReciprocalWithItsRotation) {
  for (const MetallicRoughness& material : materials()) {
    const Brdf brdf = make_brdf(material);
    Pcg32 random(9);
    for (int i = 0; i < 200; ++i) {
      const Direction a = random_upper(random), b = random_upper(random);
      const Colour there = evaluate(brdf, a, b), back = evaluate(brdf, b, a);
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(there[c], back[c], 1e-9 * (1 + back[c]));
    }
  }
}

TEST(Brdf, DensityIntegratesToOne) {
  for (const MetallicRoughness& material : materials()) {
    const Brdf brdf = make_brdf(material);
    const double theta = 0.8;
    const Direction eye = from_angles(theta, 0.5);
    const double phi = 0.5 + pi;
    std::vector<Box> sphere;
    for (const auto& [low, high] :
         {std::pair(0.0, theta), {theta, pi / 2}, {pi / 2, pi - theta}, {pi - theta, pi}}) {
      sphere.push_back({low, high, phi - pi, phi});
      sphere.push_back({low, high, phi, phi + pi});
    }
    const Integrand density = [&](std::span<const Point> points, std::span<double> values) {
      for (std::size_t i = 0; i < points.size(); ++i) {
        values[i] = pdf(brdf, from_angles(points[i].x, points[i].y), eye) * std::sin(points[i].x);
      }
    };
    EXPECT_NEAR(integrate(sphere, density, {.tolerance = 1e-5}).values[0], 1, 1e-4);
  }
}

// The furnace: unit radiance from everywhere, by sampling, against the quadrature of the lobes.
TEST(Brdf, FurnaceGivesTheAlbedo) {
  for (const MetallicRoughness& material : materials()) {
    const Brdf brdf = make_brdf(material);
    for (double theta : {0.1, 1.2}) {
      const Direction eye = from_angles(theta, 0.7);
      Pcg32 random(10);
      Colour sum(0), squares(0);
      constexpr int kCount = 50000;
      for (int i = 0; i < kCount; ++i) {
        const double u0 = random.uniform(), u1 = random.uniform(), u2 = random.uniform();
        const Direction light = sample(brdf, eye, u0, u1, u2);
        if (light.z <= 0) continue;
        const Colour term = evaluate(brdf, light, eye) * (light.z / pdf(brdf, light, eye));
        sum += term;
        squares += term * term;
      }
      const Colour expected = albedo(brdf, eye);
      for (int c = 0; c < 3; ++c) {
        const double mean = sum[c] / kCount;
        const double deviation = std::sqrt((squares[c] / kCount - mean * mean) / kCount);
        EXPECT_NEAR(mean, expected[c], 5 * deviation + 1e-5);
      }
    }
  }
}

TEST(BrdfParse, ReadsEveryModel) {
  const Direction eye = from_angles(0.5, 0.2), light = from_angles(0.7, 2.8);
  const auto expect = [&](const char* text, const Lobe& lobe) {
    const auto brdf = parse_brdf(text);
    ASSERT_TRUE(brdf) << text;
    ASSERT_EQ(brdf->lobes.size(), 1u) << text;
    EXPECT_EQ(brdf->lobes[0].lobe->key(), lobe.key()) << text;
    EXPECT_EQ(brdf->lobes[0].colour, Colour(1)) << text;
  };
  EXPECT_FALSE(parse_brdf("from-material"));
  expect("lambert", *lambert());
  expect("phong:10", *phong(10));
  expect("ggx:0.25", *ggx(0.25, 0.25));
  expect("ggx:0.1,1", *ggx(0.1, 1));
  expect("ward:0.1,0.4", *ward(0.1, 0.4));
  expect("ward:2e-1", *ward(0.2, 0.2));
  expect("ashikhmin-shirley:10,100", *ashikhmin_shirley(10, 100));
  const auto sum = parse_brdf("ashikhmin-shirley:10,100,0.3");
  const double cosine = (light + eye).normalized() ^ eye, s = std::pow(1 - cosine, 5);
  EXPECT_NEAR(evaluate(*sum, light, eye).x,
              ashikhmin_shirley(10, 100)->evaluate(light, eye) * (0.3 + 0.7 * s) +
                  0.7 * ashikhmin_shirley_diffuse()->evaluate(light, eye),
              1e-12);
}

TEST(BrdfParse, RejectsEverythingElse) {
  for (const char* text : {"",
                           "mirror",
                           "phong",
                           "phong:",
                           "phong:-1",
                           "phong:0.5",
                           "phong:1e7",
                           "phong:10,20",
                           "phong:ten",
                           "phong:10 ",
                           "ggx:0",
                           "ggx:1.5",
                           "ggx:nan",
                           "ggx:0.1,",
                           "ggx:0.1;0.2",
                           "ggx:0.1,0.2,0.3",
                           "ward:inf",
                           "lambert:1",
                           "from-material:1",
                           "Lambert",
                           "lambert:",
                           "ashikhmin-shirley:10",
                           "ashikhmin-shirley:10,10,1.5",
                           "ashikhmin-shirley:-1,10"}) {
    try {
      parse_brdf(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage) << text;
    }
  }
}

}  // namespace
}  // namespace prt::brdf
