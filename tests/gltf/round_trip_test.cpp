#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file.h"
#include "gltf/document.h"
#include "gltf/import.h"
#include "gltf/samples.h"
#include "temporary_folder.h"

namespace prt::gltf {
namespace {

void expect_same_mesh(const mesh::TriangleMesh& a, const mesh::TriangleMesh& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.tangents, b.tangents);
  EXPECT_EQ(a.texcoords, b.texcoords);
  EXPECT_EQ(a.colors, b.colors);
  EXPECT_EQ(a.indices, b.indices);
}

TEST(GltfRoundTrip, SceneComesBackAsItWas) {
  const TemporaryFolder folder;
  const mesh::Scene before = samples::scene();
  Document::from_scene(before).save_glb(folder / "a.glb");
  const mesh::Scene after = Document::load(folder / "a.glb").scene();

  ASSERT_EQ(after.primitives.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    expect_same_mesh(before.primitives[i].mesh, after.primitives[i].mesh);
    EXPECT_EQ(after.primitives[i].name, before.primitives[i].name);
    EXPECT_EQ(after.primitives[i].material, before.primitives[i].material);
  }
  ASSERT_EQ(after.materials.size(), 2u);
  EXPECT_EQ(after.materials[0].wrap_s, mesh::Wrap::clamp);
  EXPECT_EQ(after.materials[0].wrap_t, mesh::Wrap::mirror);
  EXPECT_EQ(after.materials[0].base_color_image, 0);
  EXPECT_EQ(after.materials[1].base_color, before.materials[1].base_color);
  EXPECT_TRUE(after.materials[1].double_sided);
  ASSERT_EQ(after.images.size(), 1u);
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_NEAR(after.images[0].pixels[i], before.images[0].pixels[i], 1e-6f);
  }
  EXPECT_EQ(mesh::mesh_hash(after), mesh::mesh_hash(before));
}

// The colours of three vertices stored as VEC4 of normalised T, read back through import.
template <class T>
std::vector<Vec4> colors_stored_as(int component_type, const std::vector<T>& numbers) {
  const TemporaryFolder folder;
  folder.write("colors.bin",
               {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T)});
  auto json = samples::triangle_json();
  const std::size_t bytes = numbers.size() * sizeof(T);
  json["buffers"].push_back({{"byteLength", bytes}, {"uri", "colors.bin"}});
  json["bufferViews"].push_back({{"buffer", 1}, {"byteLength", bytes}});
  json["accessors"].push_back({{"bufferView", 2},
                               {"componentType", component_type},
                               {"normalized", true},
                               {"count", 3},
                               {"type", "VEC4"}});
  json["meshes"][0]["primitives"][0]["attributes"] = {{"POSITION", 0}, {"COLOR_0", 3}};
  const auto path = folder.write("a.gltf", json.dump());
  return import_file(path, {}).document.scene().primitives[0].mesh.colors;
}

TEST(GltfRoundTrip, ColoursMayBeBytesOrShorts) {
  const std::vector<Vec4> expected{{0, 0.2f, 1, 1}, {0.4f, 0.6f, 0.8f, 1}, {1, 1, 1, 0}};
  EXPECT_EQ(
      colors_stored_as<std::uint8_t>(5121, {0, 51, 255, 255, 102, 153, 204, 255, 255, 255, 255, 0}),
      expected);
  EXPECT_EQ(colors_stored_as<std::uint16_t>(
                5123, {0, 13107, 65535, 65535, 26214, 39321, 52428, 65535, 65535, 65535, 65535, 0}),
            expected);
}

TEST(GltfRoundTrip, TransferComesBackAsItWas) {
  const TemporaryFolder folder;
  Document document = Document::from_scene(samples::scene());
  const PrecomputedTransfer before = samples::transfer(6);
  document.set_precomputed_transfer(before);
  document.save_glb(folder / "a.glb");
  const auto after = Document::load(folder / "a.glb").precomputed_transfer();

  ASSERT_TRUE(after);
  EXPECT_EQ(after->band_count, before.band_count);
  EXPECT_EQ(after->row_count, before.row_count);
  EXPECT_EQ(after->channel_count, before.channel_count);
  EXPECT_EQ(after->brdf, before.brdf);
  EXPECT_EQ(after->mesh_hash, before.mesh_hash);
  EXPECT_EQ(after->encoding.point_count, 6u);
  EXPECT_EQ(after->encoding.dimension, 27);
  EXPECT_EQ(after->encoding.means, before.encoding.means);
  EXPECT_EQ(after->encoding.bases, before.encoding.bases);
  EXPECT_EQ(after->encoding.weights, before.encoding.weights);
  EXPECT_EQ(after->encoding.cluster_of_point, before.encoding.cluster_of_point);
}

TEST(GltfRoundTrip, FileWithoutTransferHasNone) {
  EXPECT_FALSE(Document::from_scene(samples::scene()).precomputed_transfer());
}

TEST(GltfRoundTrip, MeansAloneAreATransferToo) {
  Document document = Document::from_scene(samples::scene());
  document.set_precomputed_transfer(samples::transfer(6, 2, 0));
  const auto after = document.precomputed_transfer();
  ASSERT_TRUE(after);
  EXPECT_EQ(after->encoding.component_count, 0);
  EXPECT_TRUE(after->encoding.bases.empty());
  EXPECT_TRUE(after->encoding.weights.empty());
}

// Clusters of 2, 0, 3, … components of 3.
PrecomputedTransfer adaptive_transfer() {
  PrecomputedTransfer transfer = samples::transfer(6, 4, 3);
  cpca::Encoding& encoding = transfer.encoding;
  encoding.component_counts = {2, 0, 3, 1};
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t i = encoding.component_counts[k]; i < 3; ++i) {
      std::fill_n(encoding.bases.begin() + static_cast<std::ptrdiff_t>((3 * k + i) * 27), 27, 0.0f);
    }
  }
  for (std::size_t p = 0; p < 6; ++p) {
    for (std::size_t i = encoding.component_counts[encoding.cluster_of_point[p]]; i < 3; ++i) {
      encoding.weights[3 * p + i] = 0.0f;
    }
  }
  return transfer;
}

PrecomputedTransfer after_round_trip(const PrecomputedTransfer& transfer, std::string* json) {
  Document document = Document::from_scene(samples::scene());
  const auto bare = document.glb_bytes();
  document.set_precomputed_transfer(transfer);
  const auto bytes = document.glb_bytes();
  json->assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  document = Document::parse(bytes, "a.glb");
  PrecomputedTransfer after = document.precomputed_transfer().value();
  document.remove_precomputed_transfer();
  EXPECT_EQ(document.glb_bytes(), bare);
  return after;
}

TEST(GltfRoundTrip, AdaptiveTransferAndEveryFormatOfWeightsComeBackAndGoWithoutATrace) {
  for (const bool adaptive : {false, true}) {
    for (const auto format : {cpca::WeightFormat::float32, cpca::WeightFormat::float16,
                              cpca::WeightFormat::unorm16, cpca::WeightFormat::unorm8}) {
      PrecomputedTransfer before = adaptive ? adaptive_transfer() : samples::transfer(6, 4, 5);
      cpca::convert_weights(format, before.encoding);
      before.weight_format = format;
      before.first_clusters = {0, 1, 3};
      std::string json;
      const PrecomputedTransfer after = after_round_trip(before, &json);
      EXPECT_EQ(after.weight_format, format);
      EXPECT_EQ(after.first_clusters, before.first_clusters);
      EXPECT_EQ(after.encoding.component_counts, before.encoding.component_counts);
      EXPECT_EQ(after.encoding.means, before.encoding.means);
      EXPECT_EQ(after.encoding.bases, before.encoding.bases);
      EXPECT_EQ(after.encoding.weights, before.encoding.weights);
      const bool is_half = format == cpca::WeightFormat::float16;
      const int conventions = is_half                                             ? 3
                              : adaptive || format != cpca::WeightFormat::float32 ? 2
                                                                                  : 1;
      EXPECT_NE(json.find(fmt::format("\"conventions\":{},", conventions)), std::string::npos);
      EXPECT_EQ(json.find("\"weightComponentType\":5131") != std::string::npos, is_half);
      EXPECT_EQ(json.find("_PRT_WEIGHTS_0") == std::string::npos, adaptive);
    }
  }
}

TEST(GltfRoundTrip, StoredBytesAreThoseThatTheTransferAdds) {
  for (const bool adaptive : {false, true}) {
    PrecomputedTransfer transfer = adaptive ? adaptive_transfer() : samples::transfer(6, 4, 5);
    transfer.weight_format = adaptive ? cpca::WeightFormat::unorm16 : cpca::WeightFormat::float16;
    cpca::convert_weights(transfer.weight_format, transfer.encoding);
    transfer.first_clusters = {0, 2};
    Document document = Document::from_scene(samples::scene());
    const auto binary_bytes = [&] {  // the second chunk: after the first, its own length
      const auto bytes = document.glb_bytes();
      std::uint32_t json_length = 0, length = 0;
      std::memcpy(&json_length, &bytes[12], 4);
      std::memcpy(&length, &bytes[20 + json_length], 4);
      return std::size_t{length};
    };
    const std::size_t before = binary_bytes();
    document.set_precomputed_transfer(transfer);
    const std::size_t added = binary_bytes() - before;
    EXPECT_LE(stored_bytes(transfer).total(), added);
    EXPECT_LT(added, stored_bytes(transfer).total() + 16);  // alignment between tables
  }
}

TEST(GltfRoundTrip, MoreClustersThanAnIndexCanNameAreRefused) {
  PrecomputedTransfer transfer = samples::transfer(6, 1, 0);
  Document document = Document::from_scene(samples::scene());
  const auto grow = [&](int cluster_count) {
    transfer.encoding.cluster_count = cluster_count;
    transfer.encoding.means.resize(static_cast<std::size_t>(cluster_count) * 27);
    transfer.encoding.cluster_of_point[3] = static_cast<std::uint32_t>(cluster_count - 1);
  };
  grow(65536);
  document.set_precomputed_transfer(transfer);
  EXPECT_EQ(document.precomputed_transfer()->encoding.cluster_of_point[3], 65535u);
  grow(65537);
  EXPECT_THROW(document.set_precomputed_transfer(transfer), Error);
}

TEST(GltfRoundTrip, WeightsBeyondTheRangeOfTheirFormatAreRefused) {
  for (const auto& [format, weight] : {std::pair(cpca::WeightFormat::unorm8, 1.5f),
                                       {cpca::WeightFormat::unorm16, -0.5f},
                                       {cpca::WeightFormat::float16, 65505.0f},
                                       {cpca::WeightFormat::float16, NAN}}) {
    PrecomputedTransfer transfer = samples::transfer(6);
    for (float& value : transfer.encoding.weights) value = 0.5f;
    transfer.weight_format = format;
    Document document = Document::from_scene(samples::scene());
    EXPECT_NO_THROW(document.set_precomputed_transfer(transfer));
    transfer.encoding.weights[3] = weight;
    EXPECT_THROW(document.set_precomputed_transfer(transfer), Error) << weight;
  }
}

TEST(GltfRoundTrip, WritesNoTransferThatItWouldNotRead) {
  const auto error_of = [](const PrecomputedTransfer& transfer) -> std::string {
    Document document = Document::from_scene(samples::scene());
    try {
      document.set_precomputed_transfer(transfer);
      document.precomputed_transfer();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::failed);
      EXPECT_FALSE(document.precomputed_transfer());
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(error_of(samples::transfer(6, 3, 256)), "no error");
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "number of components",
                      error_of(samples::transfer(6, 3, 257)));
  const auto error_with = [&](int PrecomputedTransfer::*field, int value) {
    PrecomputedTransfer transfer = samples::transfer(6);
    transfer.*field = value;
    return error_of(transfer);
  };
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "number of bands",
                      error_with(&PrecomputedTransfer::band_count, 17));
  for (const int count : {0, 2, 5, 254, 257, 289}) {
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "number of rows",
                        error_with(&PrecomputedTransfer::row_count, count));
  }
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "number of channels",
                      error_with(&PrecomputedTransfer::channel_count, 2));
}

TEST(GltfRoundTrip, BakingAgainDoesNotMakeTheFileGrow) {
  Document document = Document::from_scene(samples::scene());
  document.set_precomputed_transfer(samples::transfer(6, 4, 9));
  document = Document::parse(document.glb_bytes(), "a.glb");
  document.set_precomputed_transfer(samples::transfer(6));
  Document once = Document::from_scene(samples::scene());
  once.set_precomputed_transfer(samples::transfer(6));
  EXPECT_EQ(document.glb_bytes(), once.glb_bytes());
}

TEST(GltfRoundTrip, RemovedTransferLeavesTheFileItWasAddedTo) {
  Document document = Document::from_scene(samples::scene());
  const auto before = document.glb_bytes();
  document.set_precomputed_transfer(samples::transfer(6));
  document = Document::parse(document.glb_bytes(), "a.glb");
  document.remove_precomputed_transfer();
  EXPECT_EQ(document.glb_bytes(), before);
}

TEST(GltfRoundTrip, SameDocumentGivesSameBytes) {
  Document document = Document::from_scene(samples::scene());
  document.set_precomputed_transfer(samples::transfer(6));
  const auto bytes = document.glb_bytes();
  EXPECT_EQ(Document::parse(bytes, "a.glb").glb_bytes(), bytes);
}

}  // namespace
}  // namespace prt::gltf
