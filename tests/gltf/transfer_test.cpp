// PRTKIT_precomputed_transfer as a file may wrongly have it, and accessors that others share with
// it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "gltf/container.h"
#include "gltf/document.h"
#include "gltf/samples.h"
#include "temporary_folder.h"

namespace prt::gltf {
namespace {

using nlohmann::ordered_json;

// An example of the specification, to be broken.
class BrokenExample : public testing::Test {
 protected:
  explicit BrokenExample(const std::string& name)
      : json_(ordered_json::parse(
            read_text_file("../docs/extensions/PRTKIT_precomputed_transfer/" + name))) {
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
    const std::size_t stride = view.value("byteStride", 4 * sizeof(T));
    const std::size_t offset = view.value("byteOffset", std::size_t{0}) +
                               attribute(name).value("byteOffset", std::size_t{0}) +
                               vertex * stride + component * sizeof(T);
    std::memcpy(&bytes_.at(offset), &value, sizeof(T));
  }

  std::string error() {
    const TemporaryFolder folder;
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

  ordered_json json_;
  Bytes bytes_;
};

// 4 vertices, 2 clusters, 5 components, float weights.
class GltfTransfer : public BrokenExample {
 protected:
  GltfTransfer() : BrokenExample("example.gltf") {}
};

// 4 vertices, 3 clusters of 2, 0 and 3 components, weights of 8 bits, 2 superclusters.
class GltfAdaptiveTransfer : public BrokenExample {
 protected:
  GltfAdaptiveTransfer() : BrokenExample("example_adaptive.gltf") {}

  ordered_json& table(const char* key) { return json_["accessors"][header()[key].get<int>()]; }
  ordered_json& weights() {
    auto& reference = json_["meshes"][0]["primitives"][0]["extensions"];
    return reference["PRTKIT_precomputed_transfer"]["weights"];
  }
  void set_number(const char* key, std::size_t element, std::uint16_t value) {
    const ordered_json& view = json_["bufferViews"][table(key)["bufferView"].get<int>()];
    std::memcpy(&bytes_.at(view["byteOffset"].get<std::size_t>() + 2 * element), &value, 2);
  }
};

// 4 vertices, 2 clusters, 5 components, weights as half floats.
class GltfHalfTransfer : public BrokenExample {
 protected:
  GltfHalfTransfer() : BrokenExample("example_half.gltf") {}
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
       {std::pair("conventions", 4), std::pair("bandCount", 17), std::pair("channelCount", 2),
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

TEST_F(GltfTransfer, RejectsWhatTheFirstConventionsDoNotHave) {
  for (const char* name : {"_PRT_WEIGHTS_0", "_PRT_WEIGHTS_1"}) {
    attribute(name)["componentType"] = 5121;
    attribute(name)["normalized"] = true;
  }
  EXPECT_PART("normalised weights in conventions 1");
  header()["conventions"] = 2;
  EXPECT_EQ(error().find("_PRT_WEIGHTS_0"), std::string::npos);  // other bytes, the right type
  attribute("_PRT_WEIGHTS_0")["componentType"] = 5126;
  attribute("_PRT_WEIGHTS_0").erase("normalized");
  EXPECT_PART("_PRT_WEIGHTS_1: found an accessor of another type");  // all or none
}

TEST_F(GltfTransfer, TakesNormalizedIntegersOnlyAsNormalized) {
  header()["conventions"] = 2;
  attribute("_PRT_WEIGHTS_0")["componentType"] = 5123;
  EXPECT_PART("_PRT_WEIGHTS_0: found an accessor of another type");
}

TEST_F(GltfAdaptiveTransfer, ExampleIsGood) { EXPECT_EQ(error(), "no error"); }

TEST_F(GltfAdaptiveTransfer, NeedsTheSecondConventions) {
  header()["conventions"] = 1;
  EXPECT_PART("componentCounts: found conventions 1");
}

TEST_F(GltfAdaptiveTransfer, RejectsCountsAboveTheMost) {
  set_number("componentCounts", 1, 4);
  EXPECT_PART("componentCounts: found 4");
}

TEST_F(GltfAdaptiveTransfer, RejectsTablesOfOtherSizesAndTypes) {
  for (const char* key : {"componentCounts", "bases"}) {
    table(key)["count"] = table(key)["count"].get<int>() - 1;
    EXPECT_PART(key);
    table(key)["count"] = table(key)["count"].get<int>() + 1;
  }
  for (const char* key : {"componentCounts", "superclusters"}) {
    table(key)["componentType"] = 5122;
    EXPECT_PART(std::string(key) + ": found an accessor of another type");
    table(key)["componentType"] = 5123;
  }
  header()["superclusters"] = 99;
  EXPECT_PART("superclusters: found 99");
}

TEST_F(GltfAdaptiveTransfer, RejectsSuperclustersOutOfOrder) {
  for (const auto& [element, value] : {std::pair(0, 1), {1, 0}, {1, 3}}) {
    const Bytes before = bytes_;
    set_number("superclusters", static_cast<std::size_t>(element),
               static_cast<std::uint16_t>(value));
    EXPECT_PART("superclusters: found another order");
    bytes_ = before;
  }
}

TEST_F(GltfAdaptiveTransfer, RejectsWeightsOfAnotherCountOrNone) {
  json_["accessors"][weights().get<int>()]["count"] = 7;
  EXPECT_PART("weights: found 7 elements, expected 8");
  weights() = 99;
  EXPECT_PART("weights: found 99");
  json_["meshes"][0]["primitives"][0]["extensions"]["PRTKIT_precomputed_transfer"].erase("weights");
  EXPECT_PART("weights: found no whole number");
}

TEST_F(GltfAdaptiveTransfer, RejectsPaddingBeyondTheLimits) {
  // Accessors without a view are zeros that take no bytes.
  header()["bandCount"] = 16;
  header()["rowCount"] = 256;
  header()["componentCount"] = 256;
  header()["clusterCount"] = 40;
  table("means") = {{"componentType", 5126}, {"count", 40 * 65536}, {"type", "SCALAR"}};
  table("componentCounts") = {{"componentType", 5123}, {"count", 40}, {"type", "SCALAR"}};
  EXPECT_PART("bases: found 671088640 numbers");
}

TEST_F(GltfAdaptiveTransfer, RejectsRowsThatAreNoSetOfFunctions) {
  header()["rowCount"] = 2;
  EXPECT_PART("rowCount: found 2, expected 1, or n² or n² - 1");
}

TEST_F(GltfHalfTransfer, ExampleIsGood) { EXPECT_EQ(error(), "no error"); }

TEST_F(GltfHalfTransfer, RejectsInfiniteWeightsAndThoseThatAreNoNumbers) {
  for (const std::uint16_t bits : {0x7c00, 0xfc00, 0x7e00, 0x7c01, 0xffff}) {
    const Bytes before = bytes_;
    set("_PRT_WEIGHTS_0", 2, 1, bits);
    EXPECT_PART("_PRT_WEIGHTS_0: found a number that is not finite");
    bytes_ = before;
  }
}

TEST_F(GltfHalfTransfer, RejectsWeightsOfNoComponent) {
  set<std::uint16_t>("_PRT_WEIGHTS_1", 2, 1, 0x8000);  // -0
  EXPECT_EQ(error(), "no error");
  set<std::uint16_t>("_PRT_WEIGHTS_1", 2, 1, 0x0001);
  EXPECT_PART("_PRT_WEIGHTS_1: found a weight of no component");
}

TEST_F(GltfHalfTransfer, NeedsTheThirdConventions) {
  for (const int conventions : {1, 2}) {
    header()["conventions"] = conventions;
    EXPECT_PART(fmt::format("weightComponentType: found conventions {}", conventions));
  }
}

TEST_F(GltfHalfTransfer, RejectsOtherTypesThanHeaderAndSpecificationSay) {
  for (const ordered_json& type : {ordered_json(5126), ordered_json("HALF_FLOAT")}) {
    header()["weightComponentType"] = type;
    EXPECT_PART("weightComponentType: found");
  }
  header()["weightComponentType"] = 5131;
  attribute("_PRT_WEIGHTS_1")["normalized"] = true;
  EXPECT_PART("_PRT_WEIGHTS_1: found an accessor of another type");
  attribute("_PRT_WEIGHTS_1").erase("normalized");
  attribute("_PRT_WEIGHTS_0")["componentType"] = 5122;
  EXPECT_PART("_PRT_WEIGHTS_0: found an accessor of another type");
  attribute("_PRT_WEIGHTS_0")["componentType"] = 5123;
  header().erase("weightComponentType");  // integers that are not normalised are no weights
  EXPECT_PART("_PRT_WEIGHTS_0: found an accessor of another type");
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
