// What of a file a bake leaves out.
#include <gtest/gtest.h>

#include "gltf/document.h"
#include "gltf/import.h"
#include "gltf/samples.h"
#include "temporary_folder.h"

namespace prt::gltf {
namespace {

using nlohmann::ordered_json;
using Lines = std::vector<std::string>;

/// After prt-import, which gives it normals and keeps the rest.
Document imported(ordered_json json) {
  for (ordered_json& mesh : json["meshes"]) mesh["primitives"][0]["attributes"] = {{"POSITION", 0}};
  const TemporaryFolder folder;
  return import_file(folder.write("a.gltf", json.dump()), {}).document;
}

Lines lines_of(const Document& document, bool is_glossy = false) {
  return document.unbaked_features(document.scene(), is_glossy);
}

/// With its triangle of each of these materials.
Document of_materials(const std::string& materials) {
  ordered_json json = samples::triangle_json();
  json["materials"] = ordered_json::parse(materials);
  json["textures"] = ordered_json::parse(R"([{}])");
  const ordered_json node = json["nodes"][0], mesh = json["meshes"][0];
  for (std::size_t i = 0; i < json["materials"].size(); ++i) {
    json["nodes"][i] = {{"mesh", i}};
    json["scenes"][0]["nodes"][i] = i;
    json["meshes"][i] = mesh;
    json["meshes"][i]["primitives"][0]["material"] = i;
  }
  return imported(json);
}

TEST(Unbaked, IsNothingOfAPlainFile) {
  EXPECT_EQ(lines_of(imported(samples::triangle_json())), Lines());  // and without a material
  EXPECT_EQ(lines_of(Document::from_scene(samples::scene())), Lines());
}

TEST(Unbaked, SkinnedMeshesStandInBindPoseWhateverTheirNodesTransform) {
  ordered_json json = samples::triangle_json();
  json["nodes"] = ordered_json::parse(R"([
    {"mesh": 0, "skin": 0, "name": "body", "translation": [5, 0, 0], "children": [1]},
    {"mesh": 1, "name": "hat", "translation": [0, 2, 0]}])");
  json["meshes"].push_back(json["meshes"][0]);
  json["skins"] = ordered_json::parse(R"([{"joints": [1]}])");
  const Document document = imported(json);
  const mesh::Scene scene = document.scene();
  ASSERT_EQ(scene.primitives.size(), 2u);
  EXPECT_EQ(scene.primitives[0].mesh.positions[1], Vec3(1, 0, 0));
  EXPECT_EQ(scene.primitives[1].mesh.positions[1], Vec3(6, 2, 0));
  EXPECT_EQ(lines_of(document), Lines{"skins are baked in bind pose: body"});
}

TEST(Unbaked, MorphTargetsAndAnimationsAreNamed) {
  ordered_json json = samples::triangle_json();
  json["meshes"][0]["name"] = "face";
  json["meshes"][0]["primitives"][0]["targets"] = ordered_json::parse(R"([{"POSITION": 0}])");
  json["animations"] = ordered_json::parse(R"([{"channels": [], "samplers": []}])");
  const Document document = imported(json);
  EXPECT_EQ(document.scene().primitives[0].mesh.positions[1], Vec3(1, 0, 0));
  EXPECT_EQ(lines_of(document), (Lines{"morph targets are left out, whatever their weights: face",
                                       "1 animation is left out: nodes are baked as they stand"}));
}

TEST(Unbaked, FeaturesOfMaterialsAreOneLine) {
  const Document document = of_materials(R"([
    {"name": "stone", "pbrMetallicRoughness": {"metallicFactor": 0}, "normalTexture": {"index": 0}},
    {"name": "lamp", "pbrMetallicRoughness": {"metallicFactor": 0}, "emissiveFactor": [0, 2, 0],
     "normalTexture": {"index": 0}},
    {"name": "car", "pbrMetallicRoughness": {"metallicFactor": 0},
     "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1},
                    "KHR_materials_sheen": {"sheenColorFactor": [0, 0, 1]}}}])");
  const Lines expected{
      "not baked of its materials: KHR_materials_clearcoat (car); KHR_materials_sheen (car); "
      "emission (lamp); normalTexture (stone, lamp)"};
  EXPECT_EQ(lines_of(document), expected);
  EXPECT_EQ(lines_of(document, true), expected);
}

TEST(Unbaked, FeaturesWithoutEffectAreNotNamed) {
  EXPECT_EQ(lines_of(of_materials(R"([
    {"pbrMetallicRoughness": {"metallicFactor": 0}, "emissiveFactor": [0, 0, 0],
     "occlusionTexture": {"index": 0}, "emissiveTexture": {"index": 0},
     "extensions": {"KHR_materials_clearcoat": {}, "KHR_materials_ior": {"ior": 1.4},
                    "KHR_materials_transmission": {"transmissionFactor": 0},
                    "KHR_materials_sheen": {"sheenColorFactor": [0, 0, 0]}}}])")),
            Lines());
}

TEST(Unbaked, MetalsAreNamedOfDiffuseBakesUnlessNearlyMatt) {
  const Document document = of_materials(R"([
    {"name": "gold", "pbrMetallicRoughness": {"roughnessFactor": 0.3}},
    {"name": "rust", "pbrMetallicRoughness": {}},
    {"name": "varnish", "pbrMetallicRoughness": {"metallicFactor": 0.2, "roughnessFactor": 0.3}}])");
  EXPECT_EQ(lines_of(document), Lines{"metals are baked matt: gold; --mode matrix has them shine"});
  EXPECT_EQ(lines_of(document, true), Lines());
}

}  // namespace
}  // namespace prt::gltf
