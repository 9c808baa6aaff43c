#include "inspect/schema.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "sample_files.h"

namespace prt::inspect {
namespace {

class SchemaTest : public SampleFiles {
 protected:
  // Violations of a file with this extension object and that of a primitive.
  std::vector<std::string> violations(const nlohmann::json& extension,
                                      const nlohmann::json& primitive) const {
    const char* name = "PRTKIT_precomputed_transfer";
    const nlohmann::json json = {
        {"asset", {{"version", "2.0"}}},
        {"extensions", {{name, extension}}},
        {"meshes", {{{"primitives", {{{"extensions", {{name, primitive}}}}}}}}}};
    const auto path = folder() / "a.gltf";
    std::ofstream(path) << json;
    return schema_violations(path);
  }

  static nlohmann::json good() {
    return {{"transfers",
             {{{"conventions", 1},
               {"bandCount", 5},
               {"rowCount", 1},
               {"channelCount", 3},
               {"clusterCount", 256},
               {"componentCount", 8},
               {"means", 3},
               {"bases", 4}}}}};
  }
};

TEST_F(SchemaTest, AcceptsWhatThePipelineWrites) {
  EXPECT_TRUE(schema_violations(write_model()).empty());
  EXPECT_TRUE(schema_violations(write_baked(transfer())).empty());
  EXPECT_TRUE(violations(good(), {{"transfer", 0}}).empty());
}

TEST_F(SchemaTest, AcceptsTheExamplesOfTheSpecification) {
  for (const char* name :
       {"example.gltf", "example_adaptive.gltf", "example_half.gltf", "example_glossy.gltf"}) {
    const std::filesystem::path folder = "../docs/extensions/PRTKIT_precomputed_transfer";
    EXPECT_TRUE(schema_violations(folder / name).empty()) << name;
  }
}

TEST_F(SchemaTest, ComponentCountsBelongToTheSecondConventions) {
  nlohmann::json adaptive = good();
  adaptive["transfers"][0]["componentCounts"] = 5;
  EXPECT_FALSE(violations(adaptive, {{"transfer", 0}, {"weights", 6}}).empty());
  adaptive["transfers"][0]["conventions"] = 2;
  EXPECT_TRUE(violations(adaptive, {{"transfer", 0}, {"weights", 6}}).empty());
  EXPECT_FALSE(violations(adaptive, {{"transfer", 0}, {"weights", "x"}}).empty());
}

TEST_F(SchemaTest, HalfFloatsBelongToTheThirdConventions) {
  nlohmann::json half = good();
  half["transfers"][0]["weightComponentType"] = 5131;
  for (const int conventions : {1, 2, 3}) {
    half["transfers"][0]["conventions"] = conventions;
    EXPECT_EQ(violations(half, {{"transfer", 0}}).empty(), conventions == 3) << conventions;
  }
  half["transfers"][0]["componentCounts"] = 5;
  EXPECT_TRUE(violations(half, {{"transfer", 0}, {"weights", 6}}).empty());
  for (const nlohmann::json& other : {nlohmann::json(5126), nlohmann::json("HALF_FLOAT")}) {
    half["transfers"][0]["weightComponentType"] = other;
    EXPECT_FALSE(violations(half, {{"transfer", 0}, {"weights", 6}}).empty()) << other;
  }
}

TEST_F(SchemaTest, NamesWhatBreaksIt) {
  nlohmann::json bad = good();
  bad["transfers"][0]["bandCount"] = 17;
  const auto found = violations(bad, {{"transfer", -1}});
  std::string text;
  for (const std::string& line : found) text += line + "\n";
  EXPECT_NE(text.find("[transfers][0][bandCount]"), std::string::npos) << text;
  EXPECT_NE(text.find("mesh 0: primitive 0[transfer]"), std::string::npos) << text;
}

TEST_F(SchemaTest, RejectsEachBrokenField) {
  const auto broken = [](const char* key, const nlohmann::json& value) {
    nlohmann::json json = good();
    json["transfers"][0][key] = value;
    return json;
  };
  EXPECT_FALSE(violations(broken("conventions", 4), {{"transfer", 0}}).empty());
  EXPECT_FALSE(violations(broken("channelCount", 2), {{"transfer", 0}}).empty());
  EXPECT_FALSE(violations(broken("rowCount", 14), {{"transfer", 0}}).empty());
  EXPECT_FALSE(violations(broken("means", "three"), {{"transfer", 0}}).empty());
  EXPECT_FALSE(violations(broken("componentCount", 0), {{"transfer", 0}}).empty());
  EXPECT_FALSE(violations({{"transfers", nlohmann::json::array()}}, {{"transfer", 0}}).empty());
  EXPECT_FALSE(violations(nlohmann::json::object(), {{"transfer", 0}}).empty());
  EXPECT_FALSE(violations(good(), nlohmann::json::object()).empty());
}

TEST_F(SchemaTest, RejectsFilesWithoutJson) {
  const auto path = folder() / "a.gltf";
  std::ofstream(path) << "{";
  EXPECT_THROW(schema_violations(path), Error);
  std::ofstream(path) << std::string("glTF\2\0\0\0\xff\xff\xff\xff\xff\xff\xff\xffJSON", 20);
  EXPECT_THROW(schema_violations(path), Error);
}

}  // namespace
}  // namespace prt::inspect
