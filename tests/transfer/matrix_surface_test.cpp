#include "transfer/matrix_surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sh/hemisphere.h"
#include "transfer/matrix_field.h"
#include "transfer/scenes.h"

namespace prt::transfer {
namespace {

/// Relative RMS difference of exit radiance over the hemisphere, under light of the operators'
/// bands of random coefficients: ‖Q (a - b) A‖ / ‖Q b A‖ of transposed operators.
double difference(const std::vector<float>& a, const std::vector<float>& b,
                  const SurfaceOptions& options) {
  const auto rows = sh::hemisphere_functions(options.row_count);
  const auto columns = sh::hemisphere_functions(options.band_count * options.band_count);
  const ExitBasis basis(rows);
  const auto gram = sh::hemisphere_gram(columns, columns);
  const std::size_t m = rows.size(), n = columns.size();
  const auto norm = [&](const auto& value) {
    double square = 0;
    for (std::size_t f = 0; f < basis.function_count; ++f) {
      for (std::size_t j = 0; j < n; ++j) {
        double sum = 0;
        for (std::size_t k = 0; k < n; ++k) {
          for (std::size_t r = 0; r < m; ++r) {
            sum += double{basis.from_sh[r * basis.function_count + f]} * value(k * m + r) *
                   gram[k * n + j];
          }
        }
        square += sum * sum;
      }
    }
    return std::sqrt(square);
  };
  return norm([&](std::size_t i) { return double{a[i]} - double{b[i]}; }) /
         norm([&](std::size_t i) { return double{b[i]}; });
}

/// A quad of a material whose texture of 2 × 1 texels holds metallic and roughness of its left and
/// its right, sampled at the texels' centres.
mesh::Scene textured_quad(const mesh::Material& material, const Vec2& left, const Vec2& right) {
  mesh::Scene scene;
  scene.materials.push_back(material);
  scene.materials[0].metallic_roughness_image = 0;
  image::Image image(2, 1, 3);
  image.pixels = {0, left.y, left.x, 0, right.y, right.x};
  scene.images.push_back(image);
  mesh::Primitive primitive;
  primitive.mesh = grid(Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0), 1);
  primitive.mesh.texcoords = {{0.25f, 0.5f}, {0.75f, 0.5f}, {0.25f, 0.5f}, {0.75f, 0.5f}};
  primitive.material = 0;
  scene.primitives.push_back(primitive);
  return scene;
}

std::vector<float> operator_at(const MatrixSurfaces& surfaces, const mesh::Scene& scene,
                               std::size_t vertex, std::size_t channels) {
  std::vector<float> operators(channels * surfaces.operator_size());
  surfaces.at_vertex(scene.primitives[0], vertex, operators);
  return operators;
}

TEST(RoughnessBlend, IsExactForCubics) {
  const auto cubic = [](double x) { return 1 - x + 2 * x * x - 3 * x * x * x; };
  for (double roughness = 0; roughness <= 1; roughness += 0.03) {
    const RoughnessBlend blend = blend_roughness(roughness);
    double sum = 0;
    for (int k = 0; k < 4; ++k) {
      sum += blend.weights[static_cast<std::size_t>(k)] *
             cubic(static_cast<double>(blend.first + k) / kRoughnessSteps);
    }
    EXPECT_GE(blend.first, 0);
    EXPECT_LE(blend.first + 3, kRoughnessSteps);
    EXPECT_NEAR(sum, cubic(roughness), 1e-12);
  }
}

// The error that the header states, against operators of just that roughness.
TEST(MatrixSurfaces, BlendOfRoughnessIsCloseToTheExactOperator) {
  const SurfaceOptions options{.row_count = 24};
  mesh::Material material;
  for (const float metallic : {0.0f, 1.0f}) {
    material.metallic = metallic;
    for (const float roughness : {0.2f, 0.3f, 0.45f, 0.55f, 0.7f, 0.8f, 0.95f}) {
      material.roughness = 1;
      const mesh::Scene textured =
          textured_quad(material, Vec2(1, roughness), Vec2(1, roughness < 0.5f ? 1.0f : 0.25f));
      material.roughness = roughness;
      mesh::Scene plain = textured;
      plain.materials = {material};
      const MatrixSurfaces blended(textured, options, 1), exact(plain, options, 1);
      EXPECT_LT(difference(operator_at(blended, textured, 0, 1), operator_at(exact, plain, 0, 1),
                           options),
                kBlendError)
          << metallic << " " << roughness;
    }
  }
}

// At nodes nothing is blended: vertices are those of materials with just their factors.
TEST(MatrixSurfaces, TexturesAreReadAtVertices) {
  const SurfaceOptions options{.band_count = 3, .row_count = 9};
  mesh::Material material;
  material.base_color = {0.8f, 0.4f, 0.2f, 1};
  material.metallic = 0.5f;
  material.roughness = 1;
  const mesh::Scene textured = textured_quad(material, Vec2(0, 0.5f), Vec2(1, 0.75f));
  const MatrixSurfaces surfaces(textured, options, 3);
  ASSERT_EQ(surfaces.losses().size(), 1u);
  const float metallic[] = {0, 0.5f}, roughness[] = {0.5f, 0.75f};
  for (std::size_t v = 0; v < 2; ++v) {
    mesh::Scene plain = textured;
    plain.materials[0].metallic_roughness_image = -1;
    plain.materials[0].metallic = metallic[v];
    plain.materials[0].roughness = roughness[v];
    const auto expected = operator_at(MatrixSurfaces(plain, options, 3), plain, v, 3);
    const auto found = operator_at(surfaces, textured, v, 3);
    for (std::size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i], expected[i], 1e-5) << i;
  }
}

TEST(MatrixSurfaces, WithoutAMaterialReflectsAsGltfsDefaultMaterial) {
  const SurfaceOptions options{.band_count = 3, .row_count = 9};
  mesh::Scene scene = scene_of(sphere(0));
  scene.materials[0].metallic = scene.materials[0].roughness = 1;
  mesh::Scene bare = scene;
  bare.primitives[0].material = -1;
  EXPECT_EQ(operator_at(MatrixSurfaces(bare, options, 1), bare, 0, 1),
            operator_at(MatrixSurfaces(scene, options, 1), scene, 0, 1));
  EXPECT_EQ(mesh::mesh_hash(bare), mesh::mesh_hash(scene));
}

TEST(MatrixSurfaces, LossesAreThoseOfTheMaterialsInUse) {
  mesh::Scene scene = scene_of(sphere(0));
  scene.materials[0].name = "shiny";
  scene.materials[0].metallic = 1;
  scene.materials[0].roughness = 0.3f;
  scene.materials.push_back({.name = "not in use"});
  const MatrixSurfaces surfaces(scene, {.band_count = 3, .row_count = 9}, 1);
  ASSERT_EQ(surfaces.losses().size(), 1u);
  EXPECT_EQ(surfaces.losses()[0].name, "shiny");
  EXPECT_GT(surfaces.losses()[0].loss.kernel, 0.5);
  EXPECT_LT(surfaces.losses()[0].loss.exit, 0.1);
  const MatrixSurfaces named(scene, {.brdf = "lambert", .band_count = 3, .row_count = 9}, 1);
  ASSERT_EQ(named.losses().size(), 1u);
  EXPECT_EQ(named.losses()[0].name, "lambert");
  EXPECT_LT(named.losses()[0].loss.exit, 1e-6);
}

}  // namespace
}  // namespace prt::transfer
