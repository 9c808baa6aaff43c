#include "reference/path_tracer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "error_of.h"
#include "scenes.h"
#include "sh/basis.h"

namespace prt::reference {
namespace {

TEST(PathTracer, WhiteSphereVanishesInAFurnace) {
  mesh::Scene scene;
  add_sphere(scene, 0.0f, kPi, false, add_material(scene, Vec3(1.0f)));
  const auto camera = look({0.0f, 1.0f, 4.0f}, {0.0f, 0.0f, 0.0f}, 30.0f);
  const Result result = trace(scene, camera, kWhite, small(64, 64, 8));
  for_covered(result, [&](int x, int y) {
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(result.radiance.at(x, y)[c], 1.0f, 1e-4f);
  });
}

TEST(PathTracer, WhiteBowlVanishesAfterManyBounces) {
  mesh::Scene scene;
  add_sphere(scene, kPi / 2, kPi, true, add_material(scene, Vec3(1.0f)));
  const auto camera = look({0.0f, 4.0f, 0.5f}, {0.0f, -0.5f, 0.0f}, 25.0f);
  const Result result = trace(scene, camera, kWhite, small(64, 64, 100));
  for_covered(result, [&](int x, int y) { ASSERT_NEAR(result.radiance.at(x, y)[0], 1.0f, 1e-3f); });
}

// Inside a sphere every patch sees every other by its share of the sphere's area: half the light
// of a hemispherical bowl comes from the sky, half from the bowl, at every point and bounce.
TEST(PathTracer, EachBounceInABowlMatchesItsClosedForm) {
  mesh::Scene scene;
  const Vec3 albedo(0.8f, 0.5f, 0.2f);
  add_sphere(scene, kPi / 2, kPi, true, add_material(scene, albedo));
  const auto camera = look({0.0f, 4.0f, 0.5f}, {0.0f, -0.5f, 0.0f}, 25.0f);
  Vec3 expected(0.0f), power = albedo * 0.5f;
  for (int bounces = 0; bounces <= 3; ++bounces, power *= albedo * 0.5f) {
    expected += power;
    const Result result = trace(scene, camera, kWhite, small(48, 64, bounces));
    double mean = 0.0, variance = 0.0;
    int count = 0;
    for_covered(result, [&](int x, int y) {
      for (int c = 0; c < 3; ++c) {
        mean += result.radiance.at(x, y)[c] / expected[c];
        variance += std::pow(result.standard_error.at(x, y)[c] / expected[c], 2);
        ++count;
      }
    });
    // The facets of the bowl deviate from the sphere by 1.4e-4.
    EXPECT_NEAR(mean / count, 1.0, 4 * std::sqrt(variance) / count + 3e-4) << bounces;
  }
}

// Irradiance under spherical harmonics: Σ A_l l_lm Y_lm(n), the clamped cosine's A_l being
// π, 2π/3, π/4, 0, -π/24 [Ramamoorthi, Hanrahan 2001].
TEST(PathTracer, SphereUnderBandLimitedLightMatchesCosineLobe) {
  mesh::Scene scene;
  const float albedo = 0.6f;
  add_sphere(scene, 0.0f, kPi, false, add_material(scene, Vec3(albedo)));
  const auto camera = look({1.0f, 2.0f, 4.0f}, {0.0f, 0.0f, 0.0f}, 28.0f);
  const Vec3 sun = Vec3(1.0f, 2.0f, 3.0f).normalized();
  sh::Light light = sh::directional_light(5, sun, Vec3(3.0f, 2.0f, 1.0f));
  // Ringing: the light is negative 60 degrees from its middle.
  const Vec3 aside = sun * 0.5f + Vec3(2.0f, -1.0f, 0.0f).normalized() * std::sqrt(0.75f);
  ASSERT_LT(sh::light_radiance(light, aside).x, -0.1f);
  constexpr int kSize = 96;
  const Result result = trace(scene, camera, BandLimitedIllumination(light), small(kSize, 512, 2));
  const float lobe[5] = {kPi, 2.0f * kPi / 3.0f, kPi / 4.0f, 0.0f, -kPi / 24.0f};
  for (auto& channel : light.coefficients) {
    for (int l = 0; l < 5; ++l) {
      for (int m = -l; m <= l; ++m) {
        channel[static_cast<std::size_t>(sh::coefficient_index(l, m))] *= lobe[l] * albedo / kPi;
      }
    }
  }
  double error = 0.0, energy = 0.0, noise = 0.0;
  for_covered(result, [&](int x, int y) {
    // The point of the sphere that the pixel sees, by the quadratic formula.
    const float scale = 1.0f / kSize;
    const Vec3 d = camera.ray_direction((2.0f * static_cast<float>(x) + 1.0f) * scale - 1.0f,
                                        1.0f - (2.0f * static_cast<float>(y) + 1.0f) * scale);
    const float b = d.dot(camera.eye);
    const float discriminant = b * b - camera.eye.dot(camera.eye) + 1.0f;
    if (discriminant < 0.04f) return;  // grazing: the facets' outline differs from the sphere's
    const Vec3 expected = sh::light_radiance(light, camera.eye - d * (b + std::sqrt(discriminant)));
    for (int c = 0; c < 3; ++c) {
      error += std::pow(result.radiance.at(x, y)[c] - expected[c], 2);
      noise += std::pow(result.standard_error.at(x, y)[c], 2);
      energy += expected[c] * expected[c];
    }
  });
  EXPECT_GT(energy, 0.0);
  EXPECT_LT(std::sqrt(error / energy), 0.005);
  EXPECT_LT(std::sqrt(error), 1.2 * std::sqrt(noise) + 5e-4 * std::sqrt(energy));
}

// From a point below the centre of a parallel disk, F = r² / (r² + h²).
TEST(PathTracer, FloorBeneathADiskLosesItsFormFactor) {
  mesh::Scene scene;
  const int material = add_material(scene, Vec3(1.0f));
  add_quad(scene, {-5.0f, 0.0f, 5.0f}, {10.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -10.0f}, material);
  const float radius = 0.8f, height = 0.6f;
  mesh::Primitive disk;
  disk.material = add_material(scene, Vec3(0.0f));
  constexpr std::uint32_t kSides = 512;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const float angle = 2.0f * kPi * static_cast<float>(i) / kSides;
    disk.mesh.positions.push_back({radius * std::cos(angle), height, radius * std::sin(angle)});
    if (i >= 2) disk.mesh.indices.insert(disk.mesh.indices.end(), {0, i - 1, i});
  }
  disk.mesh.normals.assign(kSides, Vec3(0.0f, 1.0f, 0.0f));
  scene.primitives.push_back(disk);
  const auto camera = look({0.0f, 0.3f, 4.0f}, {0.0f, 0.0f, 0.0f}, 0.01f);
  const Result result = trace(scene, camera, kWhite, small(16, 4096, 2));
  double mean = 0.0;
  for_covered(result, [&](int x, int y) { mean += result.radiance.at(x, y)[0] / 256.0; });
  const double form_factor = radius * radius / (radius * radius + height * height);
  EXPECT_NEAR(mean, 1.0 - form_factor, 1e-4);
}

TEST(PathTracer, BackFacesBlockAndAreBlackEvenWhenDoubleSided) {
  for (const bool double_sided : {false, true}) {
    mesh::Scene scene;
    add_quad(scene, {-1.0f, 0.0f, 1.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -2.0f},
             add_material(scene, Vec3(0.5f), double_sided));
    const auto below = look({0.0f, -3.0f, 1.0f}, {0.0f, 0.0f, 0.0f}, 20.0f);
    const Result result = trace(scene, below, kWhite, small(16, 16, 1));
    for_covered(result, [&](int x, int y) { ASSERT_EQ(result.radiance.at(x, y)[0], 0.0f); });
  }
}

// Of a tilted triangle alone nothing hides the sky, wherever it stands and however large it is.
TEST(PathTracer, ATriangleOfAnySizeAndPlaceNeverHidesItsOwnSky) {
  for (const float size : {1e-6f, 1.0f, 1e4f}) {
    for (const float distance : {0.0f, 5000.0f}) {
      if (size < 1.0f && distance > 0.0f) continue;  // smaller than the numbers there resolve
      const Vec3 offset(distance, -distance, 0.5f * distance);
      mesh::Scene scene;
      mesh::Primitive primitive;
      primitive.material = add_material(scene, Vec3(1.0f));
      const Vec3 a(size, 0.3f * size, 0.1f * size), b(-0.2f * size, 0.7f * size, -0.9f * size);
      primitive.mesh.positions = {offset, offset + a, offset + b};
      primitive.mesh.normals.assign(3, (a / size).cross(b / size).normalized());
      primitive.mesh.indices = {0, 1, 2};
      scene.primitives.push_back(primitive);
      const Vec3 middle = offset + (a + b) / 3.0f;
      const auto camera = look(middle + primitive.mesh.normals[0] * (2.0f * size), middle, 30.0f);
      const Result result = trace(scene, camera, kWhite, small(64, 64, 1));
      for_covered(result, [&](int x, int y) {
        ASSERT_NEAR(result.radiance.at(x, y)[0], 1.0f, 1e-5f) << size << ", " << distance;
      });
    }
  }
}

TEST(PathTracer, TheUnitOfLengthChangesNothing) {
  mesh::Scene scene;
  add_quad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, add_material(scene, Vec3(0.7f)));
  add_quad(scene, {-0.5f, 0.5f, 0.5f}, {1, 0, 0}, {0, 0.25f, -1}, 0);
  const auto camera = look({0.5f, 1.5f, 2.5f}, {0.0f, 0.25f, 0.0f}, 30.0f);
  const Result expected = trace(scene, camera, kWhite, small(8, 64, 1));
  for (const float scale : {0x1p-60f, 0x1p60f}) {
    mesh::Scene scaled = scene;
    for (mesh::Primitive& primitive : scaled.primitives) {
      for (Vec3& p : primitive.mesh.positions) p *= scale;
    }
    camera::Camera from = camera;
    from.eye *= scale, from.target *= scale;
    EXPECT_EQ(trace(scaled, from, kWhite, small(8, 64, 1)).radiance.pixels,
              expected.radiance.pixels)
        << scale;
  }
}

TEST(PathTracer, EmptySceneShowsTheBackground) {
  const sh::Light light = sh::directional_light(3, Vec3(0.0f, 0.0f, -1.0f), Vec3(1.0f, 2.0f, 3.0f));
  const auto camera = look({0.0f, 0.0f, 4.0f}, {0.0f, 0.0f, 0.0f}, 40.0f);
  for (const PixelFilter filter : {PixelFilter::center, PixelFilter::box}) {
    Options options = small(33, 20, 2);
    options.filter = filter;
    options.background = true;
    const Result result = trace({}, camera, BandLimitedIllumination(light), options);
    const Vec3 expected = sh::light_radiance(light, Vec3(0.0f, 0.0f, -1.0f));
    const float* middle = result.radiance.at(16, 16);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(middle[c], expected[c], 1e-3f);
    EXPECT_EQ(middle[3], 0.0f);
    options.background = false;
    const Result black = trace({}, camera, BandLimitedIllumination(light), options);
    EXPECT_EQ(black.radiance.pixels, std::vector<float>(33 * 33 * 4, 0.0f));
  }
}

TEST(PathTracer, BoxFilterMeasuresCoverage) {
  mesh::Scene scene;
  add_quad(scene, {0.0f, 0.0f, 0.0f}, {9.0f, 0.0f, 0.0f}, {0.0f, 9.0f, 0.0f},
           add_material(scene, Vec3(1.0f)));
  // The quad's corner is in the middle of the middle pixel.
  const auto camera = look({0.0f, 0.0f, 4.0f}, {0.0f, 0.0f, 0.0f}, 20.0f);
  Options options = small(33, 256, 0);
  options.filter = PixelFilter::box;
  const Result result = trace(scene, camera, kWhite, options);
  const auto alpha = [&](int x, int y) { return result.radiance.at(x, y)[3]; };
  EXPECT_EQ(alpha(16, 16), 0.25f);  // exact: the samples are stratified
  EXPECT_EQ(alpha(16, 8), 0.5f);
  EXPECT_EQ(alpha(24, 16), 0.5f);
  EXPECT_EQ(alpha(24, 8), 1.0f);
  EXPECT_EQ(alpha(8, 24), 0.0f);
  EXPECT_NEAR(result.radiance.at(16, 16)[0], 0.25f, 1e-5f);
}

TEST(PathTracer, StandardErrorIsTheSpreadOverSeeds) {
  const mesh::Scene scene = corner_scene(Vec3(0.9f), Vec3(0.9f));
  const auto camera = look({0.5f, 3.0f, 1.5f}, {0.5f, 0.2f, 0.3f}, 15.0f);
  constexpr int kSize = 12, kSeeds = 48;
  std::vector<double> sum(kSize * kSize), square(sum);
  double claimed = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    Options options = small(kSize, 31, 2);
    options.seed = static_cast<std::uint64_t>(seed);
    const Result result = trace(scene, camera, kWhite, options);
    EXPECT_EQ(result.sample_count, 32);
    for (std::size_t i = 0; i < sum.size(); ++i) {
      const double value = result.radiance.pixels[4 * i];
      sum[i] += value;
      square[i] += value * value;
      claimed += std::pow(result.standard_error.pixels[3 * i], 2) / kSeeds;
    }
  }
  double spread = 0.0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    spread += (square[i] - sum[i] * sum[i] / kSeeds) / (kSeeds - 1);
  }
  // Relative deviation of a variance from kSize² * kSeeds draws is about 2%.
  EXPECT_GT(spread, 0.0);
  EXPECT_NEAR(claimed / spread, 1.0, 0.08);
}

TEST(PathTracer, SameImageForAnyThreadCount) {
  const mesh::Scene scene = corner_scene(Vec3(0.9f), Vec3(0.4f));
  const auto camera = look({0.5f, 3.0f, 1.5f}, {0.5f, 0.2f, 0.3f}, 25.0f);
  Options options = small(100, 24, 2);
  options.filter = PixelFilter::box;
  set_thread_count(1);
  const Result one = trace(scene, camera, kWhite, options);
  set_thread_count(2);
  const Result two = trace(scene, camera, kWhite, options);
  set_thread_count(0);
  EXPECT_EQ(one.radiance.pixels, two.radiance.pixels);
  EXPECT_EQ(one.standard_error.pixels, two.standard_error.pixels);
  EXPECT_EQ(one.rays_cast, two.rays_cast);
}

TEST(PathTracer, RejectsOptionsOutOfRange) {
  const auto camera = look({0.0f, 0.0f, 4.0f}, {0.0f, 0.0f, 0.0f}, 40.0f);
  for (const Options& options : {small(0, 1, 0), small(8, 0, 0), small(8, 1, -1)}) {
    EXPECT_THROW(trace({}, camera, kWhite, options), Error);
  }
}

TEST(PathTracer, NamesAVertexThatIsNotFinite) {
  mesh::Scene scene;
  add_quad(scene, Vec3(0.0f), {1, 0, 0}, {0, 1, 0}, add_material(scene, Vec3(1.0f)));
  add_quad(scene, Vec3(0.0f), {1, 0, 0}, {0, 1, 0}, 0);
  scene.primitives[1].name = "second";
  for (float bad : {INFINITY, NAN}) {
    scene.primitives[1].mesh.positions[2].y = bad;
    EXPECT_HAS(error_of([&] { trace(scene, {}, kWhite, {}); }), "second, vertex 2");
  }
}

}  // namespace
}  // namespace prt::reference
