// What prtkit does not know must come through loading, baking and saving.
#include <gtest/gtest.h>

#include <cstring>

#include "gltf/document.h"
#include "gltf/import.h"
#include "gltf/samples.h"
#include "temporary_folder.h"

namespace prt::gltf {
namespace {

using nlohmann::ordered_json;

ordered_json rich_json() {
  ordered_json json = samples::triangle_json();
  const ordered_json odd = ordered_json::parse(
      R"({"big": 12345678901, "null": null, "list": [1, 2.5, null, []], "empty": {}, "tiny": 1e-9})");
  json["extensionsUsed"] = {"FOO_bar", "KHR_lights_punctual", "KHR_materials_unlit"};
  json["extensions"] = {{"FOO_bar", odd},
                        {"KHR_lights_punctual", {{"lights", {{{"type", "point"}}}}}}};
  json["extras"] = odd;
  json["asset"]["copyright"] = "somebody";
  json["asset"]["minVersion"] = "2.0";
  json["accessors"][0]["name"] = "positions";
  json["bufferViews"][0]["extensions"]["FOO_bar"] = odd;
  json["materials"] = {{{"extensions", {{"KHR_materials_unlit", ordered_json::object()}}},
                        {"emissiveFactor", {0.1, 0.2, 0.3}}}};
  json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
  json["nodes"][0]["extras"] = odd;
  json["nodes"].push_back({{"camera", 0}, {"extensions", {{"FOO_bar", odd}}}});
  json["scenes"][0]["nodes"].push_back(1);
  json["skins"] = {{{"joints", {1}}, {"extras", odd}}};
  json["animations"] = ordered_json::parse(
      R"([{"channels": [{"sampler": 0, "target": {"node": 1, "path": "scale", "extras": {"a": 1}}}],
           "samplers": [{"input": 1, "output": 0, "extras": 9}]}])");
  auto& primitive = json["meshes"][0]["primitives"][0];
  primitive["extras"] = odd;
  primitive["attributes"]["_PRT_CHART"] = 1;  // another extension's
  primitive["targets"] = {{{"POSITION", 0}}};
  json["meshes"][0]["weights"] = {0.5};
  return json;
}

ordered_json json_of(const std::vector<std::byte>& glb) {
  std::uint32_t size;
  std::memcpy(&size, &glb[12], sizeof(size));
  return ordered_json::parse(std::string(reinterpret_cast<const char*>(&glb[20]), size));
}

// Everything of `before` but buffers, which are merged, must be in `after`, which may hold more.
void expect_contains(const ordered_json& before, const ordered_json& after,
                     const std::string& where) {
  if (before.is_object()) {
    for (const auto& [key, value] : before.items()) {
      if (where.empty() && key == "buffers") continue;
      ASSERT_TRUE(after.contains(key)) << where << "/" << key;
      expect_contains(value, after[key], where + "/" + key);
    }
  } else if (before.is_array()) {
    ASSERT_GE(after.size(), before.size()) << where;
    for (std::size_t i = 0; i < before.size(); ++i) {
      expect_contains(before[i], after[i], where + "/" + std::to_string(i));
    }
  } else {
    EXPECT_EQ(before.dump(), after.dump()) << where;
  }
}

using samples::parse;

TEST(GltfSurvival, EverythingUnknownSurvivesLoadingAndSaving) {
  expect_contains(rich_json(), json_of(parse(rich_json()).glb_bytes()), "");
}

TEST(GltfSurvival, EverythingUnknownSurvivesBakingAndBakingAgain) {
  Document document = parse(rich_json());
  document.set_precomputed_transfer(samples::transfer(3));
  expect_contains(rich_json(), json_of(document.glb_bytes()), "");
  document.set_precomputed_transfer(samples::transfer(3));
  expect_contains(rich_json(), json_of(document.glb_bytes()), "");
}

TEST(GltfSurvival, RemovingTheTransferLeavesNothingOfIt) {
  Document document = parse(rich_json());
  document.set_precomputed_transfer(samples::transfer(3));
  document.remove_precomputed_transfer();
  const std::string text = json_of(document.glb_bytes()).dump();
  for (const char* name : {"PRTKIT_", "_PRT_CLUSTER", "_PRT_WEIGHTS"}) {
    EXPECT_EQ(text.find(name), std::string::npos) << name;
  }
  EXPECT_FALSE(document.precomputed_transfer());
}

TEST(GltfSurvival, RemovingTheTransferLeavesAccessorsThatTheUnknownMayReferTo) {
  const auto accessor_counts = [](const char* pointer, std::size_t number) {
    ordered_json json = rich_json();
    json[ordered_json::json_pointer(pointer)] = number;
    Document document = parse(json);
    document.set_precomputed_transfer(samples::transfer(3));
    const std::size_t baked = json_of(document.glb_bytes())["accessors"].size();
    document.remove_precomputed_transfer();
    return std::pair(baked, json_of(document.glb_bytes())["accessors"].size());
  };
  const auto [baked, left] = accessor_counts("/materials/0/alphaCutoff", 0);
  ASSERT_LT(left, baked);
  for (const char* place : {"/materials/0/extras/a", "/materials/0/extensions/FOO_bar/a",
                            "/scenes/0/extensions/FOO_bar/a", "/cameras/0/extras/a",
                            "/accessors/0/extensions/FOO_bar/a", "/asset/extras/a/b"}) {
    EXPECT_EQ(accessor_counts(place, baked - 1).second, baked) << place;
  }
  EXPECT_EQ(accessor_counts("/materials/0/alphaCutoff", baked - 1).second, left);
}

TEST(GltfSurvival, EverythingUnknownSurvivesImport) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.gltf", rich_json().dump());
  const ImportResult result = import_file(path, {});
  ordered_json expected = rich_json();
  expected["meshes"][0]["primitives"][0].erase("attributes");  // the normals had to be replaced
  expected["meshes"][0]["primitives"][0].erase("indices");
  expected["meshes"][0]["primitives"][0].erase("targets");
  expect_contains(expected, json_of(result.document.glb_bytes()), "");
  EXPECT_EQ(result.document.scene().vertex_count(), 3u);
}

TEST(GltfSurvival, BuffersWithoutViewsStaySo) {
  ordered_json json = samples::triangle_json();
  json["nodes"][0].erase("mesh");
  for (const char* name : {"meshes", "accessors", "bufferViews"}) json.erase(name);
  const auto glb = samples::parse(json).glb_bytes();
  EXPECT_FALSE(json_of(glb).contains("bufferViews"));
  EXPECT_NO_THROW(Document::parse(glb, "a.glb"));
}

// glTF wants min and max as stored, not as scaled.
TEST(GltfSurvival, BoundsOfMovedNormalisedTargetsAreOfTheStoredNumbers) {
  ordered_json json = rich_json();
  json["accessors"].push_back({{"bufferView", 0},
                               {"byteOffset", 12},  // 0 0 -128, 63 0 0, 0 0 0
                               {"componentType", 5120},
                               {"normalized", true},
                               {"count", 3},
                               {"type", "VEC3"}});
  json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = 3;
  const TemporaryFolder folder;
  const ImportResult result = import_file(folder.write("a.gltf", json.dump()), {});
  const ordered_json after = json_of(result.document.glb_bytes());
  const auto moved = after["meshes"][0]["primitives"][0]["targets"][0]["POSITION"].get<int>();
  ASSERT_GT(moved, 3);
  EXPECT_EQ(after["accessors"][moved]["min"], ordered_json({0.0, 0.0, -128.0}));
  EXPECT_EQ(after["accessors"][moved]["max"], ordered_json({63.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace prt::gltf
