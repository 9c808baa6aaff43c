// Matrices of glTF's materials.
#include <gtest/gtest.h>

#include <cmath>

#include "brdf/brdf_matrix.h"
#include "mesh/frame.h"
#include "sh/hemisphere.h"
#include "sh/rotation.h"
#include "transfer/matrices.h"

namespace prt::transfer {
namespace {

// A floor of four materials: each vertex has the sum of its material's lobes, coloured by its
// albedo, turned as the material says.
TEST(TransferMatrix, MaterialsReflectAsGltfSays) {
  mesh::Scene scene;
  const auto add = [&](const mesh::Material& material) {
    scene.materials.push_back(material);
    mesh::Primitive primitive;
    primitive.mesh = grid(Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 0), 1);
    primitive.material = static_cast<int>(scene.materials.size()) - 1;
    scene.primitives.push_back(primitive);
  };
  add({.name = {}, .base_color = {0.9f, 0.6f, 0.3f, 1}, .metallic = 1, .roughness = 0.7f});
  add({.name = {}, .base_color = {0.2f, 0.4f, 0.6f, 1}, .metallic = 0, .roughness = 0.6f});
  add({.name = {},
       .metallic = 0.5f,
       .roughness = 0.7f,
       .ior = 1.8f,
       .specular = 0.6f,
       .specular_color = {1, 0.5f, 1}});
  add({.name = {},
       .metallic = 1,
       .roughness = 0.6f,
       .has_anisotropy = true,
       .anisotropy_strength = 0.5f,
       .anisotropy_rotation = 0.8f});
  const auto signal = bake(scene, "from-material", {.row_count = 16, .shadowed = false});
  ASSERT_EQ(signal.channel_count, 3);
  for (std::size_t p = 0; p < 4; ++p) {
    const mesh::Material& from = scene.materials[p];
    const brdf::Brdf brdf = brdf::make_brdf(
        {.base_color = brdf::Colour(double{from.base_color.x}, double{from.base_color.y},
                                    double{from.base_color.z}),
         .metallic = double{from.metallic},
         .roughness = double{from.roughness},
         .ior = double{from.ior},
         .specular = double{from.specular},
         .specular_color = brdf::Colour(from.specular_color),
         .has_anisotropy = from.has_anisotropy,
         .anisotropy_strength = double{from.anisotropy_strength},
         .anisotropy_rotation = double{from.anisotropy_rotation}});
    const auto light = random_light(5, p);
    const TriangleMesh& mesh = scene.primitives[p].mesh;
    const auto [x, y, z] = mesh::frame_at_vertex(mesh, 0);
    // Least squares moments of the exit radiance that quadrature over the lights' hemisphere gives.
    const brdf::BrdfMatrix matrix = brdf::brdf_matrix(brdf, 4, 5);
    const auto inverse =
        sh::hemisphere_projection(Kind::least_squares, sh::hemisphere_functions(16));
    const sh::Rotation rotation(
        5, Matrix4(x.x, y.x, z.x, 0, x.y, y.y, z.y, 0, x.z, y.z, z.z, 0, 0, 0, 0, 1));
    std::vector<float> turned(25);
    rotation.apply(light, turned);
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t r = 0; r < 16; ++r) {
        double expected = 0, found = 0;
        for (std::size_t i = 0; i < 16; ++i) {
          for (std::size_t j = 0; j < 25; ++j) {
            expected += inverse[r * 16 + i] * matrix.channels[c][i * 25 + j] * double{turned[j]};
          }
        }
        const float* row = &signal.values[((p * 4 * 3 + c) * 16 + r) * 25];
        for (std::size_t j = 0; j < 25; ++j) found += double{row[j]} * double{light[j]};
        ASSERT_NEAR(found, expected, 1e-3 * (1 + std::abs(expected))) << p << " " << c << " " << r;
      }
    }
  }
}

}  // namespace
}  // namespace prt::transfer
