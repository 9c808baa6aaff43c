#include "gltf/import.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "core/error.h"
#include "gltf/samples.h"
#include "temporary_folder.h"

namespace prt::gltf {
namespace {

using nlohmann::ordered_json;

class GltfImport : public testing::Test {
 protected:
  ImportResult import(const ordered_json& json, const ImportOptions& options = {}) {
    return import_file(folder_.write("a.gltf", json.dump()), options);
  }
  TemporaryFolder folder_;
};

TEST_F(GltfImport, ComputesMissingNormals) {
  ordered_json json = samples::triangle_json();
  json["meshes"][0]["primitives"][0]["attributes"] = {{"POSITION", 0}};
  const mesh::Scene scene = import(json).document.scene();
  for (const Vec3& n : scene.primitives[0].mesh.normals) EXPECT_EQ(n, Vec3(0, 0, 1));
}

TEST_F(GltfImport, LeavesAGoodFileAlone) {
  Document before = Document::from_scene(samples::scene());
  before.save_glb(folder_ / "a.glb");
  const ImportResult result = import_file(folder_ / "a.glb", {});
  EXPECT_EQ(result.document.glb_bytes(), before.glb_bytes());
}

TEST_F(GltfImport, RecomputingNormalsWeldsAndRenewsTangents) {
  mesh::Scene scene;
  mesh::TriangleMesh& mesh = scene.primitives.emplace_back().mesh;  // flat, with facets' normals
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (const Vec3& p : mesh.positions) mesh.texcoords.emplace_back(p.x, 1 - p.y);
  mesh.normals = {{0, 0.6f, 0.8f}, {0, 0.6f, 0.8f}, {0, 0.6f, 0.8f},
                  {0.6f, 0, 0.8f}, {0.6f, 0, 0.8f}, {0.6f, 0, 0.8f}};
  mesh.tangents.assign(6, Vec4(0, 1, 0, -1));
  mesh.indices = {0, 1, 2, 3, 4, 5};
  Document::from_scene(scene).save_glb(folder_ / "a.glb");
  ImportOptions options;
  options.prepare.repair.recompute_normals = true;
  const mesh::Scene result = import_file(folder_ / "a.glb", options).document.scene();
  const mesh::TriangleMesh& after = result.primitives[0].mesh;
  EXPECT_EQ(after.normals, std::vector<Vec3>(4, Vec3(0, 0, 1)));
  EXPECT_EQ(after.tangents, std::vector<Vec4>(4, Vec4(1, 0, 0, 1)));
}

TEST_F(GltfImport, RefusesTransformsThatBakingWouldRefuse) {
  const auto error_with = [&](const char* key, const ordered_json& value) -> std::string {
    ordered_json json = samples::triangle_json();
    json["meshes"][0]["primitives"][0]["attributes"].erase("NORMAL");
    json["nodes"][0][key] = value;
    try {
      import(json);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      return error.what();
    }
    return "no error";
  };
  for (const ordered_json& scale : {ordered_json{0, 0, 0}, ordered_json{1, 0, 1}}) {
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "flattens the mesh", error_with("scale", scale));
  }
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "out of the range of floats",
                      error_with("matrix", {3e38, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3e38, 0, 0, 1}));
}

TEST_F(GltfImport, GivesEachNodeAMeshOfItsOwn) {
  ordered_json json = samples::triangle_json();
  json["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 5}}});
  json["scenes"][0]["nodes"] = {0, 1};
  const mesh::Scene scene = import(json).document.scene();
  ASSERT_EQ(scene.primitives.size(), 2u);
  EXPECT_NE(scene.primitives[0].mesh_index, scene.primitives[1].mesh_index);
  EXPECT_EQ(scene.primitives[1].mesh.positions[0], Vec3(0, 0, 5));
}

TEST_F(GltfImport, TurnsStripsFansAndBareListsIntoTriangles) {
  for (const int mode : {4, 5, 6}) {
    for (const bool indexed : {true, false}) {
      ordered_json json = samples::triangle_json();
      auto& primitive = json["meshes"][0]["primitives"][0];
      primitive["mode"] = mode;
      if (!indexed) primitive.erase("indices");
      const mesh::Scene scene = import(json).document.scene();
      EXPECT_EQ(scene.triangle_count(), 1u);
      EXPECT_EQ(scene.primitives[0].mesh.normals[0], Vec3(0, 0, 1));
    }
  }
}

TEST_F(GltfImport, StripsTurnEveryOtherTriangleRound) {
  mesh::Scene quad = samples::scene();
  quad.primitives.resize(1);
  mesh::TriangleMesh& mesh = quad.primitives[0].mesh;
  mesh = {};
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}};
  mesh.normals.assign(5, Vec3(0, 0, 1));
  mesh.indices = {0, 1, 2, 3, 4, 4};
  quad.primitives[0].material = 1;
  Document document = Document::from_scene(quad);
  const auto bytes = document.glb_bytes();
  std::string glb(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t key = glb.find("\"material\":1");
  ASSERT_NE(key, std::string::npos);
  glb.replace(key, 12, "\"mode\":5    ");
  const mesh::Scene scene = import_file(folder_.write("a.glb", glb), {}).document.scene();
  EXPECT_EQ(scene.primitives[0].mesh.indices,
            (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2, 2, 3, 4}));
}

TEST_F(GltfImport, MirroredAndStretchedNodesKeepFrontsAndNormals) {
  ordered_json json = samples::triangle_json();
  json["meshes"][0]["primitives"][0]["attributes"].erase("NORMAL");
  json["nodes"][0]["scale"] = {-2, 3, 0.5};
  json["nodes"][0]["rotation"] = {std::sin(0.3), 0, 0, std::cos(0.3)};
  const mesh::Scene scene = import(json).document.scene();
  const mesh::TriangleMesh& mesh = scene.primitives[0].mesh;
  const auto [a, b, c] = mesh.triangle(0);
  const Vec3 front = (mesh.positions[b] - mesh.positions[a])
                         .cross(mesh.positions[c] - mesh.positions[a])
                         .normalized();
  for (const Vec3& n : mesh.normals) EXPECT_NEAR(n.dot(front), 1.0f, 1e-6f);
}

TEST_F(GltfImport, RefinesInWorldSpace) {
  ordered_json json = samples::triangle_json();
  json["nodes"][0]["scale"] = {10, 10, 10};
  ImportOptions options;
  options.prepare.max_edge = 4.0f;
  const mesh::Scene scene = import(json, options).document.scene();
  EXPECT_GT(scene.triangle_count(), 8u);
  const mesh::TriangleMesh& mesh = scene.primitives[0].mesh;
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const auto [a, b, c] = mesh.triangle(i);
    EXPECT_LE((mesh.positions[a] - mesh.positions[b]).length(), 4.0f);
    EXPECT_LE((mesh.positions[b] - mesh.positions[c]).length(), 4.0f);
    EXPECT_LE((mesh.positions[c] - mesh.positions[a]).length(), 4.0f);
  }
}

TEST_F(GltfImport, DropsBrokenTrianglesAndCountsThem) {
  mesh::Scene scene = samples::scene();
  scene.primitives[0].mesh.positions.push_back({std::nanf(""), 0, 0});
  scene.primitives[0].mesh.normals.push_back({0, 0, 1});
  scene.primitives[0].mesh.texcoords.push_back({0, 0});
  scene.primitives[0].mesh.colors.push_back({0, 0, 0, 1});
  auto& indices = scene.primitives[0].mesh.indices;
  indices.insert(indices.end(), {0, 1, 3, 0, 1, 1, 1, 2, 0});
  Document::from_scene(scene).save_glb(folder_ / "a.glb");
  const ImportResult result = import_file(folder_ / "a.glb", {});
  const mesh::RepairReport& repair = result.meshes[0].repair;
  EXPECT_EQ(repair.nonfinite_triangle_count, 1u);
  EXPECT_EQ(repair.nonfinite_vertex_count, 1u);
  EXPECT_EQ(repair.degenerate_triangle_count, 1u);
  EXPECT_EQ(repair.duplicate_triangle_count, 1u);
  EXPECT_EQ(result.document.scene().triangle_count(), 2u);
}

TEST_F(GltfImport, MendsColoursTextureCoordinatesAndTangentsOfWhatIsOtherwiseGood) {
  mesh::Scene scene = samples::scene();
  scene.primitives[0].mesh.colors[1] = {2, 0.5f, 0, 1};
  scene.primitives[0].mesh.texcoords[2].x = std::nanf("");
  scene.primitives[1].mesh.tangents.assign(3, {1, 0, std::nanf(""), 1});
  Document::from_scene(scene).save_glb(folder_ / "a.glb");
  const ImportResult result = import_file(folder_ / "a.glb", {});
  EXPECT_EQ(result.meshes[0].repair.mended_attribute_count, 2u);
  const mesh::Scene after = result.document.scene();
  EXPECT_EQ(after.primitives[0].mesh.colors[1], Vec4(1, 0.5f, 0, 1));
  EXPECT_EQ(after.primitives[0].mesh.texcoords[2], Vec2(0));
  ASSERT_EQ(after.primitives[1].mesh.tangents.size(), 3u);
  EXPECT_TRUE(is_finite(after.primitives[1].mesh.tangents[0]));
}

TEST_F(GltfImport, RejectsWhatHasNoTriangleLeft) {
  ordered_json json = samples::triangle_json();
  json["nodes"][0].erase("mesh");
  EXPECT_THROW(import(json), Error);
  EXPECT_THROW(import_file(folder_.write("a.obj", "v 0 0 0\nf 1 1 1\n"), {}), Error);
}

TEST_F(GltfImport, KnowsEndingsInCapitals) {
  const auto text = samples::triangle_json().dump();
  EXPECT_EQ(import_file(folder_.write("A.GLTF", text), {}).meshes.size(), 1u);
  const auto obj = folder_.write("A.OBJ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  import_file(obj, {}).document.save_glb(folder_ / "A.GLB");
  EXPECT_EQ(import_file(folder_ / "A.GLB", {}).meshes.size(), 1u);
}

TEST_F(GltfImport, WritesNamesThatAreNotUtf8) {
  folder_.write("a.mtl", "newmtl gr\xfcn\nKd 0 1 0\n");
  const auto path =
      folder_.write("a.obj", "mtllib a.mtl\nusemtl gr\xfcn\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  import_file(path, {}).document.save_glb(folder_ / "a.glb");
  const mesh::Scene scene = Document::load(folder_ / "a.glb").scene();
  EXPECT_EQ(scene.primitives[0].name, "gr\ufffdn");
  EXPECT_EQ(mesh::albedo_at_vertex(scene, scene.primitives[0], 0), Vec3(0, 1, 0));
}

// glTF wants texture coordinates wherever a texture is.
TEST_F(GltfImport, DropsTheTextureWhereTextureCoordinatesAreMissing) {
  image::write_image(folder_ / "a.png", image::Image(2, 2, 3));
  folder_.write("a.mtl", "newmtl red\nKd 1 0 0\nmap_Kd a.png\nnewmtl black\nmap_Kd a.png\n");
  const auto path = folder_.write("a.obj",
                                  "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n"
                                  "usemtl red\nf 1/1 2/1 3\nusemtl black\nf 3/1 2/1 1/1\n");
  const mesh::Scene scene = import_file(path, {}).document.scene();
  ASSERT_EQ(scene.primitives.size(), 2u);
  EXPECT_EQ(mesh::albedo_at_vertex(scene, scene.primitives[0], 0), Vec3(1, 0, 0));
  EXPECT_EQ(mesh::albedo_at_vertex(scene, scene.primitives[1], 0), Vec3(0));
  const auto has_texture = [&](std::size_t p) {
    const auto material = static_cast<std::size_t>(scene.primitives[p].material);
    return scene.materials[material].base_color_image >= 0;
  };
  EXPECT_FALSE(has_texture(0));
  EXPECT_TRUE(has_texture(1));
}

TEST_F(GltfImport, StoresOnlyTheImagesThatAreShown) {
  for (const char* name : {"a.png", "b.png", "c.png"}) {
    image::Image image(2, 2, 3);
    image.pixels[0] = name[0] == 'b' ? 1.0f : 0.0f;
    image::write_image(folder_ / name, image);
  }
  folder_.write("a.mtl",
                "newmtl a\nmap_Kd a.png\nnewmtl b\nmap_Kd b.png\nnewmtl unused\nmap_Kd c.png\n");
  const std::string vertices =
      "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1 2 3\n";
  const auto imported = [&](const std::string& text) {
    const Document document = import_file(folder_.write("a.obj", vertices + text), {}).document;
    const auto bytes = document.glb_bytes();
    const std::string content(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const mesh::Scene scene = document.scene();
    EXPECT_EQ(content.find("image/png") == content.npos, scene.images.empty());
    EXPECT_EQ(content.find("\x89PNG") == content.npos, scene.images.empty());
    EXPECT_EQ(scene.materials.size(), 3u);
    return scene;
  };
  EXPECT_TRUE(imported("").images.empty());
  const mesh::Scene scene = imported("usemtl b\nf 3/1 2/1 1/1\n");
  ASSERT_EQ(scene.images.size(), 1u);
  EXPECT_EQ(scene.images[0].pixels[0], 1.0f);
  EXPECT_EQ(scene.materials[0].base_color_image, -1);
  EXPECT_EQ(scene.materials[1].base_color_image, 0);
}

TEST_F(GltfImport, ColoursOnlyWhatHasNoMaterial) {
  folder_.write("a.mtl", "newmtl red\nKd 1 0 0\n");
  const auto path = folder_.write("a.obj",
                                  "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
                                  "usemtl red\nf 3 2 1\n");
  ImportOptions options;
  options.base_color = Vec3(0.25f, 0.5f, 0.75f);
  const mesh::Scene scene = import_file(path, options).document.scene();
  ASSERT_EQ(scene.primitives.size(), 2u);
  EXPECT_EQ(mesh::albedo_at_vertex(scene, scene.primitives[0], 0), Vec3(0.25f, 0.5f, 0.75f));
  EXPECT_EQ(mesh::albedo_at_vertex(scene, scene.primitives[1], 0), Vec3(1, 0, 0));
}

// In glTF a primitive without a material is of metal.
TEST_F(GltfImport, MeshFilesWithoutMaterialsAreMatt) {
  const auto path = folder_.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const mesh::Scene scene = import_file(path, {}).document.scene();
  const mesh::MetallicRoughness found =
      mesh::metallic_roughness_at_vertex(scene, scene.primitives.at(0), 0);
  EXPECT_EQ(found.metallic, 0);
  EXPECT_EQ(found.roughness, 1);
  EXPECT_EQ(mesh::albedo_at_vertex(scene, scene.primitives[0], 0), Vec3(1));
}

}  // namespace
}  // namespace prt::gltf
