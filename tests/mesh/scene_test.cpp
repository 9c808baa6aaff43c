#include "mesh/scene.h"

#include <gtest/gtest.h>

#include <set>

namespace prt::mesh {
namespace {

// One textured triangle, its corners at the texcoords given.
Scene textured(const std::vector<Vec2>& texcoords, Wrap wrap) {
  Scene scene;
  image::Image image(2, 1, 3);  // black, white
  for (int c = 0; c < 3; ++c) image.at(1, 0)[c] = 1.0f;
  scene.images.push_back(std::move(image));
  Material& material = scene.materials.emplace_back();
  material.base_color_image = 0;
  material.wrap_s = material.wrap_t = wrap;
  Primitive& primitive = scene.primitives.emplace_back();
  primitive.material = 0;
  primitive.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  primitive.mesh.normals.assign(3, Vec3(0, 0, 1));
  primitive.mesh.texcoords = texcoords;
  primitive.mesh.indices = {0, 1, 2};
  return scene;
}

float albedo_where(float s, Wrap wrap) {
  const Scene scene = textured(std::vector<Vec2>(3, Vec2(s, 0.5f)), wrap);
  return albedo_at_vertex(scene, scene.primitives[0], 0).x;
}

TEST(Albedo, TexturesWrapAsTheirMaterialSays) {
  // Texel centres are at 1/4 and 3/4.
  for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror}) {
    EXPECT_FLOAT_EQ(albedo_where(0.25f, wrap), 0.0f);
    EXPECT_FLOAT_EQ(albedo_where(0.5f, wrap), 0.5f);
    EXPECT_FLOAT_EQ(albedo_where(0.75f, wrap), 1.0f);
  }
  EXPECT_FLOAT_EQ(albedo_where(1.0f, Wrap::repeat), 0.5f);  // between white and the next black
  EXPECT_FLOAT_EQ(albedo_where(1.0f, Wrap::clamp), 1.0f);
  EXPECT_FLOAT_EQ(albedo_where(1.0f, Wrap::mirror), 1.0f);
  EXPECT_FLOAT_EQ(albedo_where(1.25f, Wrap::repeat), 0.0f);
  EXPECT_FLOAT_EQ(albedo_where(1.25f, Wrap::clamp), 1.0f);
  EXPECT_FLOAT_EQ(albedo_where(1.25f, Wrap::mirror), 1.0f);
  EXPECT_FLOAT_EQ(albedo_where(-1.25f, Wrap::repeat), 1.0f);
  EXPECT_FLOAT_EQ(albedo_where(-1.25f, Wrap::clamp), 0.0f);
  EXPECT_FLOAT_EQ(albedo_where(-1.25f, Wrap::mirror), 1.0f);
}

TEST(Albedo, TexturesAreLookedUpThroughTheirTransform) {
  Scene scene = textured({{0.25f, 0.5f}, {0.75f, 0.5f}, {0.5f, 0.5f}}, Wrap::clamp);
  scene.materials[0].base_color_transform.u = {-1, 0, 1};
  EXPECT_EQ(albedo_at_vertex(scene, scene.primitives[0], 0), Vec3(1));
  EXPECT_EQ(albedo_at_vertex(scene, scene.primitives[0], 1), Vec3(0));
  EXPECT_EQ(albedo_at_vertex(scene, scene.primitives[0], 2), Vec3(0.5f));
}

TEST(MeshHash, ChangesWithGeometryAndReflectionAndNothingElse) {
  const Scene scene = textured({{0.25f, 0.5f}, {0.75f, 0.5f}, {0.5f, 0.5f}}, Wrap::repeat);
  const std::string hash = mesh_hash(scene);
  Scene other = scene;
  other.materials[0].name = "another name";
  other.primitives[0].name = "another name";
  EXPECT_EQ(mesh_hash(other), hash);
  other.materials[0].base_color.x = 0.5f;
  EXPECT_NE(mesh_hash(other), hash);
  other = scene;
  other.images[0].pixels[0] = 0.1f;
  EXPECT_NE(mesh_hash(other), hash);
  other = scene;
  other.primitives[0].mesh.colors.assign(3, Vec4(0.9f));
  EXPECT_NE(mesh_hash(other), hash);
  other = scene;
  other.primitives[0].mesh.positions[0].x = 0.1f;
  EXPECT_NE(mesh_hash(other), hash);
  other = scene;
  other.primitives[0].mesh.tangents.assign(3, Vec4(1, 0, 0, 1));
  const std::string with_tangents = mesh_hash(other);
  EXPECT_NE(with_tangents, hash);
  other.primitives[0].mesh.tangents[1] = Vec4(0, 1, 0, 1);
  EXPECT_NE(mesh_hash(other), with_tangents);
}

TEST(MeshHash, ChangesWithEachFactorOfReflection) {
  const Scene scene = textured({{0.25f, 0.5f}, {0.75f, 0.5f}, {0.5f, 0.5f}}, Wrap::repeat);
  std::set<std::string> hashes{mesh_hash(scene)};
  const auto add = [&](const auto& change) {
    Scene other = scene;
    other.materials[0].has_anisotropy = true;
    change(other.materials[0]);
    hashes.insert(mesh_hash(other));
  };
  add([](Material& m) { m.metallic = 0.5f; });
  add([](Material& m) { m.roughness = 0.5f; });
  add([](Material& m) { m.ior = 1.25f; });
  add([](Material& m) { m.specular = 0.5f; });
  add([](Material& m) { m.specular_color.y = 0.5f; });
  add([](Material& m) { m.anisotropy_strength = 0.5f; });
  add([](Material& m) { m.anisotropy_rotation = 0.5f; });
  EXPECT_EQ(hashes.size(), 8u);
}

// Everything that is hashed, in numbers that floats hold exactly.
Scene of_all_kinds() {
  Scene scene = textured({{0.25f, 0.5f}, {0.75f, 0.5f}, {0.5f, 0.5f}}, Wrap::repeat);
  TriangleMesh& mesh = scene.primitives[0].mesh;
  mesh.colors = {{1, 0.5f, 0.25f, 1}, {0.5f, 0.5f, 0.5f, 1}, {0.25f, 1, 0, 1}};
  mesh.tangents.assign(3, Vec4(1, 0, 0, -1));
  Material& material = scene.materials[0];
  material.metallic = 0.5f;
  material.roughness = 0.25f;
  material.ior = 1.25f;
  material.specular = 0.5f;
  material.specular_color = {1, 0.5f, 0.25f};
  material.has_anisotropy = true;
  material.anisotropy_strength = 0.75f;
  material.anisotropy_rotation = 0.5f;
  return scene;
}

// Files keep the hash. Where this fails, the recipe has changed: raise its version in mesh_hash,
// and only then write the new hash here.
TEST(MeshHash, OfItsVersionIsTheSameInEveryBuild) {
  EXPECT_EQ(mesh_hash(of_all_kinds()), "2:18ae8f62f8878c8878cc8c8ee68300e4");
}

TEST(MeshHash, IsComparedWithHashesOfItsVersionOnly) {
  const Scene scene = of_all_kinds();
  const std::string hash = mesh_hash(scene);
  EXPECT_EQ(match_mesh_hash(hash, scene), HashMatch::same);
  Scene other = scene;
  other.primitives[0].mesh.positions[1].y = 0.5f;
  EXPECT_EQ(match_mesh_hash(hash, other), HashMatch::different);
  const std::string digits = hash.substr(hash.find(':') + 1);
  for (const std::string& unknown : {std::string(), digits, "1:" + digits, "20:" + digits})
    EXPECT_EQ(match_mesh_hash(unknown, scene), HashMatch::unknown) << unknown;
}

TEST(SceneHash, ChangesWithTheTextureBetweenTheVerticesToo) {
  const Scene scene = textured(std::vector<Vec2>(3, Vec2(0.25f, 0.5f)), Wrap::repeat);
  Scene other = scene;
  other.images[0].at(1, 0)[0] = 0.5f;
  EXPECT_EQ(mesh_hash(other), mesh_hash(scene));
  EXPECT_NE(scene_hash(other), scene_hash(scene));
  other = scene;
  other.materials[0].base_color_transform.v.z = 2.0f;  // the image has one row
  EXPECT_EQ(mesh_hash(other), mesh_hash(scene));
  EXPECT_NE(scene_hash(other), scene_hash(scene));
  other = scene;
  other.primitives[0].mesh.positions[0].x = 0.1f;
  EXPECT_NE(scene_hash(other), scene_hash(scene));
}

}  // namespace
}  // namespace prt::mesh
