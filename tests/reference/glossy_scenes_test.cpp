// Glossy reflection in frames, under whole maps and between surfaces: against plain quadrature.
#include <gtest/gtest.h>

#include <array>

#include "comparison.h"
#include "scenes.h"

namespace prt::reference {
namespace {

Vec3 from_frame(const mesh::Frame& frame, const brdf::Direction& w) {
  const Vec3 v(w);
  return frame.x * v.x + frame.y * v.y + frame.z * v.z;
}

/// ∫ f cos L over the hemisphere of a frame, L of world directions, by the midpoint rule in the
/// polar angle and the azimuth.
template <class Radiance>
Vec3 reflected(const brdf::Brdf& brdf, const mesh::Frame& frame, const Vec3& eye, int rows,
               const Radiance& radiance) {
  const double step = std::numbers::pi / 2 / rows;
  brdf::Colour sum(0);
  for (int i = 0; i < rows; ++i) {
    const double theta = (i + 0.5) * step, s = std::sin(theta), c = std::cos(theta);
    for (int j = 0; j < 4 * rows; ++j) {
      const double phi = (j + 0.5) * step;
      const brdf::Direction light(s * std::cos(phi), s * std::sin(phi), c);
      const brdf::Colour value = brdf::evaluate(brdf, light, in_frame(frame, eye));
      sum += value * brdf::Colour(radiance(from_frame(frame, light))) * (c * s * step * step);
    }
  }
  return Vec3(sum);
}

brdf::Brdf brdf_of(const brdf::MetallicRoughness& material) { return brdf::make_brdf(material); }

// A material with everything that glTF knows, on a quad whose tangents lean, of either handedness.
TEST(GlossyScenes, MaterialsAreSeenInTheFrameOfTheTangent) {
  mesh::Scene scene;
  const int material = add_material(scene, Vec3(0.8f, 0.5f, 0.3f));
  mesh::Material& from = scene.materials.back();
  from.metallic = 0.7f;
  from.roughness = 0.6f;
  from.ior = 1.8f;
  from.specular = 0.9f;
  from.specular_color = Vec3(1.0f, 0.8f, 0.6f);
  from.has_anisotropy = true;
  from.anisotropy_strength = 0.9f;
  from.anisotropy_rotation = 0.7f;
  const brdf::Brdf brdf = brdf_of({.base_color = {double{0.8f}, double{0.5f}, double{0.3f}},
                                   .metallic = double{0.7f},
                                   .roughness = double{0.6f},
                                   .ior = double{1.8f},
                                   .specular = double{0.9f},
                                   .specular_color = {1.0, double{0.8f}, double{0.6f}},
                                   .has_anisotropy = true,
                                   .anisotropy_strength = double{0.9f},
                                   .anisotropy_rotation = double{0.7f}});
  add_quad(scene, {-9.0f, 0.0f, 9.0f}, {18.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -18.0f}, material);
  const auto camera = look({2.0f, 1.5f, 1.0f}, {0.0f, 0.0f, 0.0f}, 20.0f);
  const sh::Light light =
      sh::directional_light(5, Vec3(-2.0f, 1.0f, 0.5f).normalized(), Vec3(3.0f, 2.0f, 1.0f));
  Vec3 mirrored_pixel(0.0f);
  for (const float side : {1.0f, -1.0f}) {
    SCOPED_TRACE(side);
    mesh::TriangleMesh& mesh = scene.primitives[0].mesh;
    mesh.tangents.assign(4, Vec4(0.8f, 0.0f, 0.6f, side));
    const mesh::Frame frame = mesh::frame_at_vertex(mesh, 0);
    Options options = small(2, 1 << 15, 0);
    options.brdf = "from-material";
    const Result result = trace(scene, camera, BandLimitedIllumination(light), options);
    const Comparison found = compare(result, [&](int x, int y) {
      return reflected(brdf, frame, -pixel_direction(camera, 2, x, y), 128,
                       [&](const Vec3& w) { return sh::light_radiance(light, w); });
    });
    expect_equal(found, 4, 1e-3);
    EXPECT_LT(found.noise, 0.03 * found.energy);
    const Vec3 pixel(result.radiance.at(0, 0)[0], 0.0f, 0.0f);
    EXPECT_GT(std::abs(pixel.x - mirrored_pixel.x), 0.05f * pixel.x);  // the side matters
    mirrored_pixel = pixel;
  }
}

TEST(GlossyScenes, WithoutAMaterialReflectsAsGltfsDefaultMaterial) {
  mesh::Scene scene;
  const int material = add_material(scene, Vec3(1.0f));
  scene.materials.back().metallic = scene.materials.back().roughness = 1.0f;
  add_quad(scene, {-9.0f, 0.0f, 9.0f}, {18.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -18.0f}, material);
  const auto camera = look({2.0f, 1.5f, 1.0f}, {0.0f, 0.0f, 0.0f}, 20.0f);
  const BandLimitedIllumination light(
      sh::directional_light(5, Vec3(-2.0f, 1.0f, 0.5f).normalized(), Vec3(3.0f, 2.0f, 1.0f)));
  Options options = small(2, 64, 0);
  options.brdf = "from-material";
  const Result expected = trace(scene, camera, light, options);
  scene.primitives[0].material = -1;
  EXPECT_EQ(trace(scene, camera, light, options).radiance.pixels, expected.radiance.pixels);
}

// A texture of two texels: what is beside their middles has the roughness and metallic of one.
TEST(GlossyScenes, TexturesOfRoughnessAndMetallicAreThoseOfThePoint) {
  mesh::Scene scene;
  const int material = add_material(scene, Vec3(0.8f, 0.5f, 0.3f));
  mesh::Material& from = scene.materials.back();
  from.metallic = 1.0f;
  from.roughness = 0.8f;
  from.metallic_roughness_image = 0;
  from.metallic_roughness_wrap_s = from.metallic_roughness_wrap_t = mesh::Wrap::clamp;
  image::Image texture(2, 1, 3);
  texture.pixels = {0.0f, 0.5f, 1.0f, 0.0f, 1.0f, 0.25f};
  scene.images.push_back(texture);
  add_quad(scene, {-9.0f, 0.0f, 9.0f}, {18.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -18.0f}, material);
  scene.primitives[0].mesh.texcoords = {{0.0f, 1.0f}, {1.0f, 1.0f}, {1.0f, 0.0f}, {0.0f, 0.0f}};
  const mesh::Frame frame = mesh::frame_at_vertex(scene.primitives[0].mesh, 0);
  const sh::Light light =
      sh::directional_light(5, Vec3(-1.0f, 2.0f, -1.0f).normalized(), Vec3(3.0f, 2.0f, 1.0f));
  for (const bool right : {false, true}) {
    SCOPED_TRACE(right);
    const brdf::Brdf brdf = brdf_of({.base_color = {double{0.8f}, double{0.5f}, double{0.3f}},
                                     .metallic = right ? 0.25 : 1.0,
                                     .roughness = right ? 0.8 : 0.4});
    const float x0 = right ? 7.0f : -7.0f;
    const auto camera = look({x0 + 1.0f, 1.5f, 1.0f}, {x0, 0.0f, 0.0f}, 20.0f);
    Options options = small(2, 1 << 14, 0);
    options.brdf = "from-material";
    const Result result = trace(scene, camera, BandLimitedIllumination(light), options);
    const Comparison found = compare(result, [&](int x, int y) {
      return reflected(brdf, frame, -pixel_direction(camera, 2, x, y), 96,
                       [&](const Vec3& w) { return sh::light_radiance(light, w); });
    });
    expect_equal(found, 4, 3e-3);
    EXPECT_LT(found.noise, 0.03 * found.energy);
  }
}

// A sun of one texel and a sky: sharp lobes find the sky, the sun must be sampled.
TEST(GlossyScenes, SharpAndBroadLobesUnderASmallSun) {
  image::Image map(128, 64, 3);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) map.at(x, y)[0] = 0.2f + 0.1f * std::sin(0.2f * x);
  }
  map.at(30, 12)[0] = 2000.0f;
  mesh::Scene scene;
  add_quad(scene, {-9.0f, 0.0f, 9.0f}, {18.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -18.0f},
           add_material(scene, Vec3(0.5f)));
  const mesh::Frame frame = mesh::frame_at_vertex(scene.primitives[0].mesh, 0);
  const auto camera = look({2.0f, 2.5f, 1.0f}, {0.0f, 0.0f, 0.0f}, 10.0f);
  for (const char* name : {"ggx:0.6", "ggx:0.05", "ward:0.1,0.4", "phong:3"}) {
    SCOPED_TRACE(name);
    brdf::Brdf brdf = *brdf::parse_brdf(name);
    brdf.lobes[0].colour = brdf::Colour(0.5);
    Options options = small(2, 1024, 0);
    options.brdf = name;
    const Result result = trace(scene, camera, EnvironmentIllumination(map), options);
    const Comparison found = compare(result, [&](int x, int y) {
      return reflected(brdf, frame, -pixel_direction(camera, 2, x, y), 256,
                       [&](const Vec3& w) { return image::environment_radiance(map, w); });
    });
    expect_equal(found, 4, 3e-3);
    EXPECT_LT(found.noise, 0.03 * found.energy);
  }
}

// A metal floor and a plastic wall, unit squares that meet at a right angle, under white light.
class GlossyCorner {
 public:
  GlossyCorner() {
    const auto add = [&](float metallic, float roughness, const Vec3& colour) {
      add_material(scene, colour);
      scene.materials.back().metallic = metallic;
      scene.materials.back().roughness = roughness;
      brdfs_.push_back(brdf_of({.base_color = brdf::Colour(colour),
                                .metallic = double{metallic},
                                .roughness = double{roughness}}));
    };
    add(1.0f, 0.6f, Vec3(0.9f, 0.7f, 0.5f));
    add(0.0f, 0.5f, Vec3(0.2f, 0.5f, 0.9f));
    add_quad(scene, {0.0f, 0.0f, 1.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}, 0);
    add_quad(scene, {0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, 1);
  }

  /// Radiance that the floor sends to the eye after one bounce.
  Vec3 from_floor(const Vec3& p, const Vec3& eye) const {
    return reflected(brdfs_[0], frame(0), eye, 40, [&](const Vec3& w) {
      const Vec3 hit = p - w * (p.z / w.z);
      return w.z < 0.0f && inside(hit.x, hit.y) ? from_wall(hit, -w) : Vec3(1.0f);
    });
  }

  mesh::Scene scene;

 private:
  static bool inside(float a, float b) { return a > 0.0f && a < 1.0f && b > 0.0f && b < 1.0f; }
  mesh::Frame frame(std::size_t i) const {
    return mesh::frame_at_vertex(scene.primitives[i].mesh, 0);
  }

  Vec3 from_wall(const Vec3& p, const Vec3& eye) const {
    return reflected(brdfs_[1], frame(1), eye, 14, [&](const Vec3& w) {
      const Vec3 hit = p - w * (p.y / w.y);
      return w.y < 0.0f && inside(hit.x, hit.z) ? Vec3(0.0f) : Vec3(1.0f);
    });
  }

  std::vector<brdf::Brdf> brdfs_;
};

TEST(GlossyScenes, OneBounceBetweenMetalAndPlasticMatchesQuadrature) {
  const GlossyCorner corner;
  // Towards the wall, whose mirror image the floor shows.
  const auto camera = look({0.4f, 0.6f, 1.2f}, {0.5f, 0.0f, 0.3f}, 10.0f);
  Options options = small(2, 1 << 15, 1);
  options.brdf = "from-material";
  const BandLimitedIllumination white(sh::constant_light(1, Vec3(1.0f)));
  const Result result = trace(corner.scene, camera, white, options);
  const Comparison found = compare(result, [&](int x, int y) {
    const Vec3 d = pixel_direction(camera, 2, x, y);
    return corner.from_floor(camera.eye - d * (camera.eye.y / d.y), -d);
  });
  expect_equal(found, 4, 4e-3);
  EXPECT_LT(found.noise, 3e-3 * found.energy);
}

// Light from a far away and an eye far away change places: all light that the scene sends from one
// to the other stays the same [Helmholtz].
TEST(GlossyScenes, LightAndEyeChangePlaces) {
  const GlossyCorner corner;
  constexpr int kRow = 40, kColumns[2] = {75, 110};  // of a sun of one texel
  const auto direction = [&](int i) {
    return image::direction_from_latlong((static_cast<float>(kColumns[i]) + 0.5f) / 256,
                                         (kRow + 0.5f) / 128);
  };
  const auto received = [&](int sun, int eye, int bounces) {
    image::Image map(256, 128, 3);
    map.at(kColumns[sun], kRow)[0] = 1000.0f;
    const Vec3 target(0.5f, 0.3f, 0.3f);
    Options options = small(48, 128, bounces);
    options.filter = PixelFilter::box;
    options.brdf = "from-material";
    const Result result = trace(corner.scene, look(target + direction(eye) * 200.0f, target, 0.5f),
                                EnvironmentIllumination(map), options);
    double sum = 0.0, variance = 0.0;
    for (std::size_t i = 0; i < 48 * 48; ++i) {
      sum += result.radiance.pixels[4 * i];
      variance += std::pow(result.standard_error.pixels[3 * i], 2);
    }
    return std::array{sum, variance};
  };
  const auto there = received(0, 1, 2), back = received(1, 0, 2), direct = received(0, 1, 0);
  EXPECT_GT(there[0], 1.02 * direct[0]);
  EXPECT_NEAR(there[0], back[0], 4 * std::sqrt(there[1] + back[1]) + 4e-3 * there[0]);
  EXPECT_LT(std::sqrt(there[1]), 0.01 * there[0]);
}

}  // namespace
}  // namespace prt::reference
