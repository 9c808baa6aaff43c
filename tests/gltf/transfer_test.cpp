// PRTKIT_precomputed_transfer as a file may wrongly have it, and accessors that others share with
// it.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "gltf/container.h"
#include "gltf/document.h"
#include "gltf/samples.h"

namespace prt::gltf {
namespace {

using nlohmann::ordered_json;

// The example of the specification (4 vertices, 2 clusters, 5 components), to be broken.
class GltfTransfer : public testing::Test {
 protected:
  GltfTransfer() {
    const std::string uri = json_["buffers"][0]["uri"];
    bytes_ = decode_data_uri(uri, {"a.gltf", "buffer 0"});
  }

  ordered_json& attribute(const char* name) {
    auto& primitive = json_["meshes"][0]["primitives"][0];
    return json_["accessors"][primitive["attributes"][name].get<std::size_t>()];
  }

  // Sets one element of an attribute, `component` of it.
  template <class T>
  void set(const char* name, std::size_t vertex, std::size_t component, T value) {
    const ordered_json& view = json_["bufferViews"][attribute(name)["bufferView"].get<int>()];
    const std::size_t stride = view.value("byteStride", std::size_t{16});
    const std::size_t offset = view.value("byteOffset", std::size_t{0}) +
                               attribute(name).value("byteOffset", std::size_t{0}) +
                               vertex * stride + component * sizeof(T);
    std::memcpy(&bytes_.at(offset), &value, sizeof(T));
  }

  std::string error() {
    const samples::TemporaryFolder folder;
    folder.write("a.bin", {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()});
    json_["buffers"][0]["uri"] = "a.bin";
    try {
      Document::load(folder.write("a.gltf", json_.dump())).precomputed_transfer();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      return error.what();
    }
    return "no error";
  }

  ordered_json& header() {
    return json_["extensions"]["PRTKIT_precomputed_transfer"]["transfers"][0];
  }

  ordered_json json_ = ordered_json::parse(
      read_text_file("../docs/extensions/PRTKIT_precomputed_transfer/example.gltf"));
  Bytes bytes_;
};

#define EXPECT_PART(part) EXPECT_PRED_FORMAT2(testing::IsSubstring, part, error())

TEST_F(GltfTransfer, ExampleIsGood) { EXPECT_EQ(error(), "no error"); }

TEST_F(GltfTransfer, RejectsClusterPastTheLast) {
  set<std::uint16_t>("_PRT_CLUSTER", 3, 0, 2);
  EXPECT_PART("cluster index past the last cluster: found 2");
}

TEST_F(GltfTransfer, RejectsWeightsOfNoComponent) {
  set("_PRT_WEIGHTS_1", 2, 1, 0.5f);
  EXPECT_PART("_PRT_WEIGHTS_1: found a weight of no component");
}

TEST_F(GltfTransfer, RejectsWeightsThatAreNotFinite) {
  set("_PRT_WEIGHTS_0", 1, 2, std::numeric_limits<float>::infinity());
  EXPECT_PART("_PRT_WEIGHTS_0: found a number that is not finite");
}

TEST_F(GltfTransfer, RejectsMissingWeights) {
  json_["meshes"][0]["primitives"][0]["attributes"].erase("_PRT_WEIGHTS_1");
  EXPECT_PART("_PRT_WEIGHTS_1: found nothing");
}

TEST_F(GltfTransfer, RejectsAttributesOfOtherTypes) {
  attribute("_PRT_CLUSTER")["componentType"] = 5121;
  EXPECT_PART("_PRT_CLUSTER: found an accessor of another type");
}

TEST_F(GltfTransfer, RejectsNumbersOutOfRange) {
  for (const auto& [key, value] :
       {std::pair("conventions", 2), std::pair("bandCount", 17), std::pair("channelCount", 2),
        std::pair("clusterCount", 0), std::pair("componentCount", -1), std::pair("means", 999)}) {
    const ordered_json before = header()[key];
    header()[key] = value;
    EXPECT_PART(key);
    header()[key] = before;
  }
}

TEST_F(GltfTransfer, RejectsHeadersOfTheWrongKind) {
  auto& extension = json_["extensions"]["PRTKIT_precomputed_transfer"];
  for (const ordered_json& transfers :
       {ordered_json(3), ordered_json::array({1}), ordered_json::array({header(), header()})}) {
    extension = {{"transfers", transfers}};
    EXPECT_PART("an array of one object");
  }
}

TEST_F(GltfTransfer, RemovingKeepsAccessorsThatOthersUse) {
  const std::size_t last = json_["accessors"].size() - 1;
  json_["extensions"]["FOO_bar"] = {{"accessor", last}};
  const std::string text = json_.dump();
  Document document = Document::parse(std::as_bytes(std::span(text)), "a.gltf");
  const std::size_t before = document.glb_bytes().size();
  document.remove_precomputed_transfer();
  const auto after = document.glb_bytes();
  EXPECT_LT(after.size(), before);
  const std::string kept(reinterpret_cast<const char*>(&after[20]), after.size() - 20);
  EXPECT_NE(kept.find("\"FOO_bar\":{\"accessor\":" + std::to_string(last)), std::string::npos);
  EXPECT_NO_THROW(Document::parse(after, "a.glb"));
}

}  // namespace
}  // namespace prt::gltf
