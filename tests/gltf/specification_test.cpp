// The example and the numbers of docs/extensions/PRTKIT_precomputed_transfer, which were made from
// the text of the specification by other code than ours.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/file.h"
#include "gltf/document.h"
#include "mesh/frame.h"
#include "sh/basis.h"
#include "sh/hemisphere.h"

namespace prt::gltf {
namespace {

const std::filesystem::path kFolder = "../docs/extensions/PRTKIT_precomputed_transfer";

nlohmann::json test_vectors() {
  return nlohmann::json::parse(read_text_file(kFolder / "test_vectors.json"));
}

TEST(Specification, BasisFunctionsAreOurs) {
  const nlohmann::json cases = test_vectors().at("basis");
  ASSERT_GE(cases.size(), 2u);
  for (const auto& entry : cases) {
    const auto d = entry.at("direction").get<std::vector<float>>();
    const auto expected = entry.at("values").get<std::vector<float>>();
    ASSERT_EQ(expected.size(), 25u);
    std::vector<float> values(25);
    sh::evaluate(5, {d[0], d[1], d[2]}, values);
    for (std::size_t i = 0; i < 25; ++i) EXPECT_NEAR(values[i], expected[i], 1e-6f) << i;
  }
}

// `vectors`: a file, lights and the exit radiance of each of its vertices under them.
void expect_exit_radiance(const nlohmann::json& vectors) {
  const Document document = Document::load(kFolder / vectors.at("file").get<std::string>());
  const auto transfer = document.precomputed_transfer();
  ASSERT_TRUE(transfer);
  const cpca::Encoding& encoding = transfer->encoding;
  ASSERT_EQ(encoding.point_count, document.scene().vertex_count());
  ASSERT_GE(vectors.at("cases").size(), 3u);
  const auto n = static_cast<std::size_t>(transfer->band_count * transfer->band_count);
  const std::size_t channel_stride = transfer->channel_count == 3 ? n : 0;
  for (const auto& entry : vectors.at("cases")) {
    const auto light = entry.at("light").get<std::vector<std::vector<float>>>();
    const auto expected = entry.at("exitRadiance").get<std::vector<std::vector<float>>>();
    ASSERT_EQ(expected.size(), encoding.point_count);
    std::vector<float> row(static_cast<std::size_t>(encoding.dimension));
    for (std::size_t vertex = 0; vertex < encoding.point_count; ++vertex) {
      cpca::reconstruct(encoding, vertex, row);
      for (std::size_t c = 0; c < 3; ++c) {
        float radiance = 0.0f;
        for (std::size_t i = 0; i < n; ++i)
          radiance += row[c * channel_stride + i] * light.at(c).at(i);
        EXPECT_NEAR(radiance, expected[vertex].at(c), 1e-5f) << vertex << " " << c;
      }
    }
  }
}

TEST(Specification, ExampleGivesTheExitRadianceOfTheTestVectors) {
  expect_exit_radiance(test_vectors().at("fixed"));
}

TEST(Specification, AdaptiveExampleWithNormalizedWeightsDoesToo) {
  const nlohmann::json vectors = test_vectors().at("adaptive");
  expect_exit_radiance(vectors);
  const auto transfer =
      Document::load(kFolder / vectors.at("file").get<std::string>()).precomputed_transfer();
  EXPECT_EQ(transfer->weight_format, cpca::WeightFormat::unorm8);
  EXPECT_EQ(transfer->encoding.component_counts, std::vector<std::uint32_t>({2, 0, 3}));
  EXPECT_EQ(transfer->first_clusters, std::vector<std::uint32_t>({0, 2}));
}

TEST(Specification, ExampleWithHalfFloatsDoesToo) {
  const nlohmann::json vectors = test_vectors().at("half");
  expect_exit_radiance(vectors);
  const auto transfer =
      Document::load(kFolder / vectors.at("file").get<std::string>()).precomputed_transfer();
  EXPECT_EQ(transfer->weight_format, cpca::WeightFormat::float16);
  ASSERT_GE(vectors.at("values").size(), 10u);
  for (const auto& entry : vectors.at("values")) {
    EXPECT_EQ(cpca::weight_from_half(entry.at("bits").get<std::uint16_t>()),
              entry.at("value").get<float>());
  }
}

TEST(Specification, GlossyExampleGivesTheRadianceTowardsTheEye) {
  const nlohmann::json vectors = test_vectors().at("glossy");
  const Document document = Document::load(kFolder / vectors.at("file").get<std::string>());
  const auto transfer = document.precomputed_transfer();
  ASSERT_TRUE(transfer);
  const mesh::TriangleMesh mesh = document.scene().primitives.at(0).mesh;
  const auto functions = sh::hemisphere_functions(transfer->row_count);
  ASSERT_EQ(functions, std::vector<int>({0, 1, 3}));
  ASSERT_GE(vectors.at("cases").size(), 3u);
  std::vector<float> row(static_cast<std::size_t>(transfer->encoding.dimension)), basis(4);
  for (const auto& entry : vectors.at("cases")) {
    const auto light = entry.at("light").get<std::vector<std::vector<float>>>();
    const auto eye = entry.at("toEye").get<std::vector<float>>();
    const Vec3 to_eye(eye[0], eye[1], eye[2]);
    for (std::size_t vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
      cpca::reconstruct(transfer->encoding, vertex, row);
      const mesh::Frame frame = mesh::frame_at_vertex(mesh, vertex);
      sh::evaluate(2, {to_eye.dot(frame.x), to_eye.dot(frame.y), to_eye.dot(frame.z)}, basis);
      for (std::size_t c = 0; c < 3; ++c) {
        float radiance = 0.0f;
        for (std::size_t r = 0; r < 3; ++r)
          for (std::size_t i = 0; i < 4; ++i)
            radiance += row[(c * 3 + r) * 4 + i] * light[c].at(i) *
                        basis[static_cast<std::size_t>(functions[r])];
        EXPECT_NEAR(radiance, entry.at("exitRadiance").at(vertex).at(c).get<float>(), 1e-5f)
            << vertex << " " << c;
      }
    }
  }
}

TEST(Specification, FramesOfAMirroredNodeAreMirrored) {
  const auto path = kFolder / "example_glossy.gltf";
  nlohmann::json json = nlohmann::json::parse(read_text_file(path));
  const mesh::TriangleMesh plain = Document::load(path).scene().primitives.at(0).mesh;
  json.at("nodes").at(0)["scale"] = {-1, 1, 1};
  const std::string text = json.dump();
  const mesh::TriangleMesh mirrored =
      Document::parse(std::as_bytes(std::span(text)), path).scene().primitives.at(0).mesh;
  ASSERT_EQ(plain.vertex_count(), 4u);
  for (std::size_t vertex = 0; vertex < 3; ++vertex) {  // the last one's tangent says nothing
    const mesh::Frame before = mesh::frame_at_vertex(plain, vertex);
    const mesh::Frame after = mesh::frame_at_vertex(mirrored, vertex);
    for (const auto& [a, b] :
         {std::pair(before.x, after.x), std::pair(before.y, after.y), std::pair(before.z, after.z)})
      EXPECT_LT((Vec3(-a.x, a.y, a.z) - b).length(), 1e-6f) << vertex;
  }
}

}  // namespace
}  // namespace prt::gltf
