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

TEST(Unbaked, IsNothingOfAPlainFile) {
  EXPECT_EQ(samples::parse(samples::triangle_json()).unbaked_features(), Lines());
  EXPECT_EQ(Document::from_scene(samples::scene()).unbaked_features(), Lines());
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
  EXPECT_EQ(document.unbaked_features(), Lines{"skins are baked in bind pose: body"});
}

TEST(Unbaked, MorphTargetsAndAnimationsAreNamed) {
  ordered_json json = samples::triangle_json();
  json["meshes"][0]["name"] = "face";
  json["meshes"][0]["primitives"][0]["targets"] = ordered_json::parse(R"([{"POSITION": 0}])");
  json["animations"] = ordered_json::parse(R"([{"channels": [], "samplers": []}])");
  const Document document = imported(json);
  EXPECT_EQ(document.scene().primitives[0].mesh.positions[1], Vec3(1, 0, 0));
  EXPECT_EQ(document.unbaked_features(),
            (Lines{"morph targets are left out, whatever their weights: face",
                   "1 animation is left out: nodes are baked as they stand"}));
}

}  // namespace
}  // namespace prt::gltf
