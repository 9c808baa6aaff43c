#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "gltf/document.h"
#include "gltf/samples.h"

namespace prt::gltf {
namespace {

using nlohmann::ordered_json;

/// The sample scene with another JSON object as its second material, read back.
mesh::Scene read_scene(const ordered_json& material) {
  std::vector<std::byte> glb = Document::from_scene(samples::scene()).glb_bytes();
  std::uint32_t size = 0;
  std::memcpy(&size, &glb[12], 4);
  ordered_json json = ordered_json::parse(std::string(reinterpret_cast<char*>(&glb[20]), size));
  json["materials"][1] = material;
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::vector<std::byte> changed(glb.begin(), glb.begin() + 20);
  const auto chars = std::as_bytes(std::span(text));
  changed.insert(changed.end(), chars.begin(), chars.end());
  changed.insert(changed.end(), glb.begin() + 20 + size, glb.end());
  const auto total = static_cast<std::uint32_t>(changed.size());
  const auto length = static_cast<std::uint32_t>(text.size());
  std::memcpy(&changed[8], &total, 4);
  std::memcpy(&changed[12], &length, 4);
  return Document::parse(changed, "a.glb").scene();
}

mesh::Material read_material(const ordered_json& material) {
  return read_scene(material).materials[1];
}

TEST(GltfMaterial, HasTheDefaultsOfTheSpecification) {
  const mesh::Material material = read_material(ordered_json::object());
  EXPECT_EQ(material.metallic, 1);
  EXPECT_EQ(material.roughness, 1);
  EXPECT_EQ(material.ior, 1.5f);
  EXPECT_EQ(material.specular, 1);
  EXPECT_EQ(material.specular_color, Vec3(1));
  EXPECT_FALSE(material.has_anisotropy);
  EXPECT_FALSE(material.has_unread_textures);
}

TEST(GltfMaterial, ReadsFactorsOfReflection) {
  const mesh::Material material = read_material(ordered_json::parse(R"({
    "pbrMetallicRoughness": {"metallicFactor": 0.25, "roughnessFactor": 0.5},
    "extensions": {
      "KHR_materials_ior": {"ior": 1.75},
      "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [0.25, 2, 1]},
      "KHR_materials_anisotropy": {"anisotropyStrength": 0.75, "anisotropyRotation": -1.5}}})"));
  EXPECT_EQ(material.metallic, 0.25f);
  EXPECT_EQ(material.roughness, 0.5f);
  EXPECT_EQ(material.ior, 1.75f);
  EXPECT_EQ(material.specular, 0.5f);
  EXPECT_EQ(material.specular_color, Vec3(0.25f, 2, 1));
  EXPECT_TRUE(material.has_anisotropy);
  EXPECT_EQ(material.anisotropy_strength, 0.75f);
  EXPECT_EQ(material.anisotropy_rotation, -1.5f);
}

TEST(GltfMaterial, LimitsWhatIsOutOfRangeAndIgnoresWhatIsNoNumber) {
  const mesh::Material wild = read_material(ordered_json::parse(R"({
    "extensions": {
      "KHR_materials_ior": {"ior": 0.5},
      "KHR_materials_specular": {"specularFactor": 7, "specularColorFactor": [-1, 1e30, 1]},
      "KHR_materials_anisotropy": {"anisotropyStrength": -3, "anisotropyRotation": 1e30}}})"));
  EXPECT_EQ(wild.ior, 1);
  EXPECT_EQ(wild.specular, 1);
  EXPECT_EQ(wild.specular_color, Vec3(0, 1e6f, 1));
  EXPECT_EQ(wild.anisotropy_strength, 0);
  EXPECT_EQ(wild.anisotropy_rotation, 1e3f);
  const mesh::Material odd = read_material(ordered_json::parse(R"({
    "extensions": {
      "KHR_materials_ior": [],
      "KHR_materials_specular": {"specularFactor": "1", "specularColorFactor": [1, 2]},
      "KHR_materials_anisotropy": {"anisotropyStrength": {}}}})"));
  EXPECT_EQ(odd.ior, 1.5f);
  EXPECT_EQ(odd.specular, 1);
  EXPECT_EQ(odd.specular_color, Vec3(1));
  EXPECT_EQ(odd.anisotropy_strength, 0);
}

// Numbers, not colours: the sample's image is decoded once more without sRGB, and a primitive's
// vertices have the factors times its green and blue.
TEST(GltfMaterial, ReadsTheTextureOfMetallicAndRoughness) {
  mesh::Scene scene = read_scene(ordered_json::parse(R"({"pbrMetallicRoughness": {
    "metallicFactor": 0.5, "metallicRoughnessTexture": {"index": 0}}})"));
  EXPECT_EQ(scene.materials[1].metallic_roughness_image, 1);
  EXPECT_EQ(scene.materials[0].metallic_roughness_image, -1);
  EXPECT_FALSE(scene.materials[1].has_unread_textures);
  ASSERT_EQ(scene.images.size(), 2u);
  EXPECT_EQ(scene.images[1].pixels, scene.images[0].pixels);  // of 0 and 1 only
  mesh::Primitive& primitive = scene.primitives[0];
  primitive.material = 1;
  primitive.mesh.texcoords.assign(primitive.mesh.vertex_count(), Vec2(0.25f, 0.75f));  // blue
  const auto at = mesh::metallic_roughness_at_vertex(scene, primitive, 0);
  EXPECT_EQ(at.metallic, 0.5f);
  EXPECT_EQ(at.roughness, 0.0f);
}

// A texture of red, green above blue, white turns clockwise, as the extension has it.
TEST(GltfMaterial, MovesTexturesByTheirTransform) {
  const mesh::Scene scene = read_scene(ordered_json::parse(R"({"pbrMetallicRoughness": {
    "baseColorTexture": {"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform":
      {"offset": [0, 1], "rotation": 1.5707963, "texCoord": 0}}},
    "metallicRoughnessTexture": {"index": 0, "extensions": {"KHR_texture_transform":
      {"offset": [0.25, -1], "scale": [2, 3], "rotation": 0.5}}}}})"));
  mesh::Primitive primitive;
  primitive.material = 1;
  const auto albedo = [&](float s, float t) {
    return mesh::albedo_at(scene, primitive, Vec2(s, t), Vec4(1));
  };
  EXPECT_LT((albedo(0.25f, 0.25f) - Vec3(0, 0, 1)).length(), 1e-5f);
  EXPECT_LT((albedo(0.75f, 0.25f) - Vec3(1, 0, 0)).length(), 1e-5f);
  EXPECT_LT((albedo(0.25f, 0.75f) - Vec3(1, 1, 1)).length(), 1e-5f);
  EXPECT_LT((albedo(0.75f, 0.75f) - Vec3(0, 1, 0)).length(), 1e-5f);
  const mesh::TextureTransform& second = scene.materials[1].metallic_roughness_transform;
  const float c = std::cos(0.5f), s = std::sin(0.5f);
  EXPECT_LT((second.u - Vec3(2 * c, 3 * s, 0.25f)).length(), 1e-6f);
  EXPECT_LT((second.v - Vec3(-2 * s, 3 * c, -1)).length(), 1e-6f);
  EXPECT_EQ(read_material(ordered_json::parse(R"({"pbrMetallicRoughness": {"baseColorTexture":
    {"index": 0, "extensions": {"KHR_texture_transform": {"texCoord": 1}}}}})"))
                .base_color_image,
            -1);
}

TEST(GltfMaterial, SaysThatTexturesOfFactorsAreNotRead) {
  EXPECT_TRUE(read_material(ordered_json::parse(R"({"extensions": {"KHR_materials_anisotropy":
    {"anisotropyTexture": {"index": 0}}}})"))
                  .has_unread_textures);
}

}  // namespace
}  // namespace prt::gltf
