// One test for each way in which a file can be wrong: a clear error of kind bad_input that names
// the element.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "gltf/container.h"
#include "gltf/document.h"
#include "gltf/malformed.h"
#include "temporary_folder.h"

namespace prt::gltf {
namespace {

using samples::parse;

TEST(GltfRead, SampleIsOnlyWrongInItsNormals) {
  EXPECT_ERROR(samples::triangle_json(), "not of unit length");
}

TEST(GltfRead, RejectsMissingFile) {
  EXPECT_ERROR([] { Document::load("no/such.glb"); }, "no such file");
}

TEST(GltfRead, RejectsWrongMagic) {
  EXPECT_ERROR([] { Document::parse(bytes_of("v 0 0 0\nv 1 0 0\n"), "a.glb"); }, "not a glTF file");
}

TEST(GltfRead, RejectsEmptyFile) {
  EXPECT_ERROR([] { Document::parse({}, "a.glb"); }, "not a glTF file");
}

TEST(GltfRead, RejectsGlbTruncatedAnywhere) {
  Document document = Document::from_scene(samples::scene());
  const auto bytes = document.glb_bytes();
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    const std::string error =
        error_of([&] { Document::parse(std::span(bytes).subspan(0, size), "a.glb"); });
    EXPECT_NE(error, "no error") << size;
  }
}

TEST(GltfRead, RejectsChunkPastTheEnd) {
  auto bytes = Document::from_scene(samples::scene()).glb_bytes();
  const std::uint32_t huge = 0xfffffff0u;
  std::memcpy(&bytes[12], &huge, sizeof(huge));
  EXPECT_ERROR([&] { Document::parse(bytes, "a.glb"); }, "a chunk runs past the end");
}

TEST(GltfRead, RejectsDeeplyNestedJson) {
  const std::string text = "{\"asset\":" + std::string(100000, '[');
  EXPECT_ERROR([&] { Document::parse(bytes_of(text), "a.gltf"); }, "nested too deeply");
}

TEST(GltfRead, RejectsOtherVersions) {
  EXPECT_ERROR(with("/asset/version", "1.0"), "not glTF 2.0");
}

TEST(GltfRead, RejectsAccessorPastBufferEnd) {
  EXPECT_ERROR(with("/accessors/0/count", 4), "accessor 0: runs past the end of its buffer view");
  EXPECT_ERROR(with("/accessors/0/count", std::uint64_t{1} << 62), "accessor 0");
  EXPECT_ERROR(with("/accessors/0/byteOffset", 4), "accessor 0: runs past the end");
}

TEST(GltfRead, RejectsBufferViewPastBufferEnd) {
  EXPECT_ERROR(with("/bufferViews/1/byteLength", 7), "bufferView 1: runs past the end");
  EXPECT_ERROR(with("/bufferViews/1/byteOffset", ~std::uint64_t{0}),
               "bufferView 1: runs past the end");
}

TEST(GltfRead, RejectsTruncatedBuffer) {
  EXPECT_ERROR(with("/buffers/0/byteLength", 43), "buffer 0: the buffer is truncated");
}

TEST(GltfRead, RejectsUnalignedAccessor) {
  ordered_json json = with("/accessors/0/byteOffset", 2);
  json["accessors"][0]["count"] = 2;
  EXPECT_ERROR(json, "accessor 0: not aligned");
}

TEST(GltfRead, RejectsBadStride) {
  EXPECT_ERROR(with("/bufferViews/0/byteStride", 6), "bufferView 0: bad stride");
  EXPECT_ERROR(with("/bufferViews/0/byteStride", 8), "elements larger than the stride");
}

TEST(GltfRead, RejectsUnknownTypes) {
  EXPECT_ERROR(with("/accessors/0/componentType", 5124), "accessor 0: unknown component type");
  EXPECT_ERROR(with("/accessors/0/type", "VEC5"), "accessor 0: unknown type");
  EXPECT_ERROR(with("/accessors/0/count", "three"), "accessor 0: bad \"count\"");
  EXPECT_ERROR(with("/accessors/0/count", -3), "accessor 0: bad \"count\"");
  EXPECT_ERROR(with("/meshes/0/primitives/0/attributes/NORMAL", 1), "NORMAL of a wrong type");
}

TEST(GltfRead, RejectsSparseBeyondTheAccessor) {
  EXPECT_ERROR(with("/accessors/2/sparse/count", 4), "accessor 2: more sparse elements");
  ordered_json json = with("/accessors/2/count", 2);
  json["accessors"][2]["sparse"]["count"] = 2;
  json["accessors"][2]["sparse"]["indices"]["byteOffset"] = 2;
  json["meshes"][0]["primitives"][0]["attributes"] = {{"POSITION", 2}};
  EXPECT_ERROR(json, "sparse index past the accessor's end");
}

TEST(GltfRead, RejectsEndlessZeros) {
  EXPECT_ERROR(
      with("/accessors/3", {{"componentType", 5126}, {"count", 4000000000u}, {"type", "VEC3"}}),
      "accessor 3: too many elements without data");
}

TEST(GltfRead, RejectsIndexPastLastVertex) {
  ordered_json json = samples::triangle_json();
  json["accessors"][0]["count"] = json["accessors"][2]["count"] = 2;
  json["accessors"][2].erase("sparse");
  EXPECT_ERROR(json, "index 2: index past the last vertex");
}

TEST(GltfRead, RejectsReferencesPastTheirArrays) {
  EXPECT_ERROR(with("/nodes/0/mesh", 1), "node 0");
  EXPECT_ERROR(with("/meshes/0/primitives/0/indices", 9), "primitive 0");
  EXPECT_ERROR(with("/meshes/0/primitives/0/material", 0), "primitive 0");
  EXPECT_ERROR(with("/scenes/0/nodes/0", 1), "scene 0");
  EXPECT_ERROR(with("/scene", 1), "default scene");
}

TEST(GltfRead, RejectsBadTransforms) {
  EXPECT_ERROR(with("/nodes/0/matrix", {1, 2, 3}), "node 0: bad \"matrix\"");
  EXPECT_ERROR(with("/nodes/0/translation", {0, 0, 1e300}), "node 0: bad \"translation\"");
  EXPECT_ERROR(with("/nodes/0/scale", "large"), "node 0: bad \"scale\"");
}

TEST(GltfRead, RejectsBadMaterials) {
  EXPECT_ERROR(with("/materials", {{{"doubleSided", 1}}}), "material 0: bad \"doubleSided\"");
  const auto of = [](const ordered_json& pbr) {
    return with("/materials", {{{"pbrMetallicRoughness", pbr}}});
  };
  EXPECT_ERROR(of({{"baseColorFactor", {1, 1, 1}}}), "material 0: bad \"baseColorFactor\"");
  EXPECT_ERROR(of({{"baseColorTexture", {{"index", 0}}}}), "material 0: bad \"index\"");
  EXPECT_ERROR(of({{"metallicRoughnessTexture", {{"index", 0}}}}), "material 0: bad \"index\"");
  EXPECT_ERROR(with("/textures", {{{"source", 0}}}), "texture 0: bad \"source\"");
  // what only tinygltf looks at
  EXPECT_ERROR(with("/materials", {{{"emissiveFactor", {1}}}}), "bad glTF: Array length");
}

TEST(GltfRead, RejectsNodeCycle) {
  ordered_json json = with("/nodes/0/children", {1});
  json["nodes"].push_back({{"children", {2}}});
  json["nodes"].push_back({{"children", {0}}});
  EXPECT_ERROR(json, "cycle");
  EXPECT_ERROR(with("/nodes/0/children", {0}), "cycle");
}

TEST(GltfRead, RejectsNodeOfTwoParents) {
  ordered_json json = with("/nodes/0/children", {2});
  json["nodes"].push_back({{"children", {2}}});
  json["nodes"].push_back(ordered_json::object());
  EXPECT_ERROR(json, "node 2: a node with two parents");
}

TEST(GltfRead, RejectsTooDeepNodes) {
  ordered_json json = samples::triangle_json();
  for (int i = 1; i < 300; ++i) {
    json["nodes"].back()["children"] = {i};
    json["nodes"].push_back(ordered_json::object());
  }
  EXPECT_ERROR(json, "nested too deeply");
}

TEST(GltfRead, RejectsMorePrimitivesThanTheLimitHoweverTheyAreShared) {
  ordered_json json = samples::triangle_json();
  ordered_json& primitives = json["meshes"][0]["primitives"];
  const ordered_json primitive = primitives[0], node = json["nodes"][0];
  for (int i = 1; i < 300; ++i) {
    primitives.push_back(primitive);
    json["nodes"].push_back(node);
  }
  EXPECT_ERROR(json, "too many primitives: found 90000, expected at most 65536");
}

TEST(GltfRead, RejectsMeshesThatAreLargerWhenEveryNodeHasItsOwn) {
  ordered_json json = samples::triangle_json();
  json["meshes"][0]["extras"] = std::string(100000, 'x');
  const ordered_json node = json["nodes"][0];
  for (int i = 1; i < 1000; ++i) json["nodes"].push_back(node);
  EXPECT_ERROR(json, "meshes used too often");
}

TEST(GltfRead, RejectsNodesThatTheSceneShowsTwice) {
  EXPECT_ERROR(with("/scenes/0/nodes", {0, 0}), "a node that the scene shows twice");
}

TEST(GltfRead, RejectsPrimitivesWithoutPositions) {
  EXPECT_ERROR(with("/meshes/0/primitives/0/attributes", ordered_json::object()), "no positions");
}

TEST(GltfRead, RejectsObjectsOfTooManyKeys) {
  ordered_json json = samples::triangle_json();
  ordered_json extras = ordered_json::object();
  for (int i = 0; i < 4096; ++i) extras[std::to_string(i)] = i;
  json["extras"] = extras;
  EXPECT_ERROR(json, "not of unit length");  // the sample's only fault
  json["extras"]["one more"] = 0;
  EXPECT_ERROR(json, "too many keys");
}

TEST(GltfRead, RejectsTooManyZerosInAll) {
  ordered_json json = samples::triangle_json();
  const ordered_json zeros{{"componentType", 5126}, {"count", 1 << 21}, {"type", "MAT4"}};
  json["accessors"].push_back(zeros);
  EXPECT_ERROR(json, "not of unit length");
  json["accessors"].push_back(zeros);
  EXPECT_ERROR(json, "too many elements without data");
}

TEST(GltfRead, RejectsDataLargerThanTheLimit) {
  const std::string text = samples::triangle_json().dump();
  EXPECT_ERROR([&] { Document::parse(bytes_of(text), "a.gltf", {.max_file_bytes = 20}); },
               "too large");
}

TEST(GltfRead, RejectsCompressedGeometry) {
  EXPECT_ERROR(with("/extensionsRequired", {"KHR_draco_mesh_compression"}),
               "unsupported extension: found KHR_draco_mesh_compression");
  ordered_json json = samples::triangle_json();
  json["buffers"][0].erase("uri");
  EXPECT_ERROR(json, "compressed data is not supported");
}

TEST(GltfRead, RejectsRequiredExtensionsThatWouldChangeTheAlbedo) {
  for (const char* name :
       {"EXT_texture_webp", "KHR_texture_basisu", "KHR_materials_pbrSpecularGlossiness"}) {
    EXPECT_ERROR(with("/extensionsRequired", {name}), name);
  }
  EXPECT_ERROR(with("/extensionsRequired", {"KHR_texture_transform"}), "not of unit length");
}

TEST(GltfRead, RejectsPositionsThatAreNotFinite) {
  ordered_json json = samples::triangle_json();
  std::string uri = json["buffers"][0]["uri"];
  uri.replace(uri.find(',') + 1, 6, "AADAfw");  // the first x is NaN
  json["buffers"][0]["uri"] = uri;
  EXPECT_ERROR(json, "a position that is not finite");
}

TEST(GltfRead, RejectsColoursAndTextureCoordinatesThatAreNotFinite) {
  mesh::Scene scene = samples::scene();
  scene.primitives[1].mesh.colors[2].y = std::nanf("");
  EXPECT_ERROR([&] { Document::from_scene(scene).scene(); }, "a colour that is not finite");
  scene = samples::scene();
  scene.primitives[0].mesh.texcoords[0].x = std::nanf("");
  EXPECT_ERROR([&] { Document::from_scene(scene).scene(); }, "a texture coordinate that is not");
}

TEST(GltfRead, RejectsEmptyScene) {
  EXPECT_ERROR(with("/scenes/0/nodes", ordered_json::array()), "no triangles");
}

TEST(GltfRead, AdvisesImportForWhatBakingCannotUse) {
  EXPECT_ERROR(with("/meshes/0/primitives/0/mode", 5), "prt-import");
  EXPECT_ERROR(with("/meshes/0/primitives/0/attributes", {{"POSITION", 0}}), "prt-import");
  ordered_json json = samples::triangle_json();
  json["meshes"][0]["primitives"][0].erase("indices");
  EXPECT_ERROR(json, "prt-import");
}

}  // namespace
}  // namespace prt::gltf
