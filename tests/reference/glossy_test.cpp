// Glossy reflection on convex bodies, where light and BRDF alone decide: against the quadrature
// that the matrices of the bake are made by.
#include <gtest/gtest.h>

#include "brdf/lobe_matrix.h"
#include "comparison.h"
#include "scenes.h"
#include "sh/basis.h"
#include "sh/rotation.h"

namespace prt::reference {
namespace {

const char* const kBrdfs[] = {"lambert",
                              "phong:10",
                              "ggx:0.25",
                              "ggx:0.05",
                              "ward:0.2",
                              "ward:0.1,0.4",
                              "ashikhmin-shirley:10,100",
                              "ashikhmin-shirley:40,10,0.3"};

// A white tilted quad fills the picture; its frame is the world's X axis made orthogonal to the
// normal.
TEST(GlossyPathTracer, FlatBodyInAFurnaceShowsTheAlbedo) {
  mesh::Scene scene;
  add_quad(scene, {-50.0f, 0.0f, 50.0f}, {100.0f, 0.0f, 0.0f}, {0.0f, 20.0f, -100.0f},
           add_material(scene, Vec3(1.0f)));
  const mesh::Frame frame = mesh::frame_at_vertex(scene.primitives[0].mesh, 0);
  constexpr int kSize = 6;
  const auto camera = look({1.0f, 11.5f, 2.0f}, {0.0f, 10.0f, 0.0f}, 50.0f);
  for (const char* name : kBrdfs) {
    SCOPED_TRACE(name);
    Options options = small(kSize, 1024, 3);
    options.brdf = name;
    const auto brdf = brdf::parse_brdf(name);
    const Result result = trace(scene, camera, kWhite, options);
    double largest = 0;
    const Comparison found = compare(result, [&](int x, int y) {
      const brdf::Direction eye = in_frame(frame, -pixel_direction(camera, kSize, x, y));
      brdf::Colour albedo(0);
      for (const auto& [colour, lobe] : brdf->lobes) {
        albedo += colour * brdf::directional_albedo(*lobe, eye, 1e-4);
      }
      largest = std::max(largest, albedo.x);
      return Vec3(albedo);
    });
    expect_equal(found, kSize * kSize, 3e-4);
    EXPECT_GT(largest, 0.4);
    EXPECT_LT(largest, 1.0 + 1e-3);
  }
}

// The moments of a lobe towards an eye, light function by light function: what B integrates.
TEST(GlossyPathTracer, SphereUnderOneFunctionIsTheMomentsOfTheLobe) {
  mesh::Scene scene;
  add_sphere(scene, 0.0f, kPi, false, add_material(scene, Vec3(0.8f, 0.6f, 0.4f)));
  mesh::TriangleMesh& mesh = scene.primitives[0].mesh;
  const auto tangent_at = [](const Vec3& p) { return Vec3(p.z, 0.0f, -p.x).normalized(); };
  for (const Vec3& p : mesh.positions) {
    const Vec3 tangent = tangent_at(p);
    mesh.tangents.emplace_back(tangent.x, tangent.y, tangent.z, 1.0f);
  }
  constexpr int kSize = 8, kBands = 5;
  const auto camera = look({1.0f, 1.0f, 4.0f}, {0.0f, 0.0f, 0.0f}, 26.0f);
  for (const char* name : {"phong:10", "ggx:0.25", "ward:0.1,0.4"}) {
    const auto lobe = brdf::parse_brdf(name)->lobes[0].lobe;
    // Moments in each pixel's frame, turned to functions of the world.
    std::array<std::optional<std::vector<float>>, kSize * kSize> responses;
    for (int i = 0; i < kSize * kSize; ++i) {
      const Vec3 d = pixel_direction(camera, kSize, i % kSize, i / kSize);
      const float b = d.dot(camera.eye);
      const float discriminant = b * b - camera.eye.dot(camera.eye) + 1.0f;
      if (discriminant < 0.04f) continue;  // grazing: the facets' outline differs from the sphere's
      const Vec3 normal = camera.eye - d * (b + std::sqrt(discriminant));
      const Vec3 x = tangent_at(normal), y = normal.cross(x);
      const auto moments =
          brdf::lobe_moments(*lobe, in_frame({x, y, normal}, -d), kBands, 1e-4).values;
      const std::vector<float> local(moments.begin(), moments.begin() + kBands * kBands);
      const Matrix4 world_from_local(x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, normal.x, normal.y,
                                     normal.z, 0, 0, 0, 0, 1);
      responses[static_cast<std::size_t>(i)].emplace(local.size());
      sh::Rotation(kBands, world_from_local).apply(local, *responses[static_cast<std::size_t>(i)]);
    }
    for (const int function : {0, 2, 5, 13, 23}) {
      SCOPED_TRACE(testing::Message() << name << ", function " << function);
      sh::Light light(kBands);
      for (auto& channel : light.coefficients) channel[static_cast<std::size_t>(function)] = 1.0f;
      Options options = small(kSize, 1024, 0);
      options.brdf = name;
      const Result result = trace(scene, camera, BandLimitedIllumination(light), options);
      const Comparison found = compare(result, [&](int x, int y) -> std::optional<Vec3> {
        const auto& response = responses[static_cast<std::size_t>(y * kSize + x)];
        if (!response) return std::nullopt;
        return Vec3(0.8f, 0.6f, 0.4f) * (*response)[static_cast<std::size_t>(function)];
      });
      expect_equal(found, kSize * kSize / 2, 2e-3);
      EXPECT_LT(found.noise, 0.03 * found.energy);
    }
  }
}

// The back wall of a bowl sees the bowl: every bounce adds light, and all of them together give no
// more than came in.
TEST(GlossyPathTracer, BouncesInABowlAddUpToLessThanTheFurnace) {
  mesh::Scene scene;
  add_sphere(scene, kPi / 2, kPi, true, add_material(scene, Vec3(1.0f)));
  const auto camera = look({0.0f, 4.0f, 0.5f}, {0.0f, -0.5f, 0.0f}, 25.0f);
  for (const char* name : kBrdfs) {
    SCOPED_TRACE(name);
    double before = 0.0;
    for (const int bounces : {0, 1, 16}) {
      Options options = small(16, 128, bounces);
      options.brdf = name;
      const Result result = trace(scene, camera, kWhite, options);
      double sum = 0.0;
      for_covered(result, [&](int x, int y) {
        sum += result.radiance.at(x, y)[0] / 256;
        EXPECT_LT(result.radiance.at(x, y)[0],
                  1.0f + 4 * result.standard_error.at(x, y)[0] + 1e-3f);
      });
      EXPECT_GT(sum, before + 0.01);
      before = sum;
    }
  }
}

// Normals that lean 60° away from the quad's own: seen from 45° below their horizon it looks as
// seen from the horizon itself.
TEST(GlossyPathTracer, EyesBelowTheHorizonSeeWhatTheHorizonSees) {
  mesh::Scene scene;
  add_quad(scene, {-500.0f, 0.0f, 500.0f}, {1000.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1000.0f},
           add_material(scene, Vec3(1.0f)));
  const Vec3 normal(std::sqrt(0.75f), 0.5f, 0.0f), horizon(-0.5f, std::sqrt(0.75f), 0.0f);
  for (Vec3& n : scene.primitives[0].mesh.normals) n = normal;
  const Vec3 below = (horizon - normal).normalized();
  ASSERT_GT(below.y, 0.2f);
  for (const char* name : {"lambert", "phong:1", "ggx:0.8"}) {
    SCOPED_TRACE(name);
    const auto mean = [&](const Vec3& eye) {
      Options options = small(8, 4096, 0);
      options.brdf = name;
      const Result result = trace(scene, look(eye, Vec3(0.0f), 0.01f), kWhite, options);
      double sum = 0.0;
      for (std::size_t i = 0; i < 64; ++i) sum += result.radiance.pixels[4 * i] / 64.0;
      return sum;
    };
    const double expected = mean(horizon);
    EXPECT_GT(expected, 0.02);
    EXPECT_NEAR(mean(below), expected, 5e-3 * expected);
  }
}

TEST(GlossyPathTracer, RejectsABrdfThatIsNone) {
  Options options = small(8, 1, 0);
  options.brdf = "mirror";
  EXPECT_ANY_THROW(trace({}, look({0.0f, 0.0f, 4.0f}, Vec3(0.0f), 40.0f), kWhite, options));
}

}  // namespace
}  // namespace prt::reference
