#include "inspect/inspection.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/error.h"
#include "core/file.h"
#include "core/random.h"
#include "cpca/encoder.h"
#include "gltf/document.h"
#include "image/image.h"
#include "sample_files.h"
#include "sh/light.h"
#include "sh/radiance_metric.h"
#include "signal/npz.h"

namespace prt::inspect {
namespace {

class InspectionTest : public SampleFiles {};

TEST_F(InspectionTest, ModelShowsItsMeshes) {
  const Inspection inspection = inspect_file(write_model());
  EXPECT_TRUE(inspection.valid());
  const Json& model = inspection.json["model"];
  EXPECT_EQ(inspection.json["kind"], "model");
  EXPECT_EQ(model["vertex_count"], 8);
  EXPECT_EQ(model["triangle_count"], 4);
  ASSERT_EQ(model["primitives"].size(), 2u);
  EXPECT_EQ(model["primitives"][1]["bounds_min"], Json({2.0, 0.0, 0.0}));
  EXPECT_EQ(model["primitives"][1]["bounds_max"], Json({3.0, 1.0, 0.0}));
  EXPECT_FALSE(inspection.json.contains("precomputed_transfer"));
}

TEST_F(InspectionTest, BakedModelShowsItsClusters) {
  const Inspection inspection = inspect_file(write_baked(transfer()));
  EXPECT_TRUE(inspection.valid());
  const Json& baked = inspection.json["precomputed_transfer"];
  EXPECT_EQ(baked["cluster_count"], 2);
  EXPECT_EQ(baked["component_count"], 1);
  EXPECT_EQ(baked["unused_cluster_count"], 0);
  EXPECT_EQ(baked["cluster_size"]["max"], 5);
  // 8 points: indices of 4 bytes, weights of 16; 2 means and 2 vectors of 4 floats.
  EXPECT_EQ(baked["bytes"]["total"], 8 * 4 + 8 * 16 + 2 * 16 + 2 * 16);
  EXPECT_EQ(baked["bytes"]["uncompressed"], 8 * 4 * 4);
  EXPECT_LT(baked["orthonormality_error"], 1e-6);
}

TEST_F(InspectionTest, HalfFloatsTakeHalfTheRoomAndThoseThatAreNoNumbersAreFindings) {
  gltf::PrecomputedTransfer half = transfer();
  half.weight_format = cpca::WeightFormat::float16;
  const auto path = write_baked(half);
  const Inspection good = inspect_file(path);
  EXPECT_TRUE(good.valid()) << to_text(good.json);
  EXPECT_EQ(good.json["precomputed_transfer"]["weights"], "half");
  EXPECT_EQ(good.json["precomputed_transfer"]["bytes"]["weights"], 8 * 8);

  // The last vertex has weight 1.5; an infinite one and one that is no number in its place.
  std::string bytes = read_text_file(path);
  const std::string last("\x00\x3e\x00\x00\x00\x00\x00\x00", 8);
  const std::size_t at = bytes.rfind(last);
  ASSERT_NE(at, bytes.npos);
  for (const char* bits : {"\x00\x7c", "\x00\xfc", "\x01\x7e"}) {
    bytes.replace(at, 2, bits, 2);
    std::ofstream(path, std::ios::binary) << bytes;
    const Inspection bad = inspect_file(path);
    EXPECT_FALSE(bad.valid());
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "a number that is not finite", to_text(bad.json));
  }
}

TEST_F(InspectionTest, FindsWhatIsOddInABakedModel) {
  gltf::PrecomputedTransfer bad = transfer();
  bad.mesh_hash.back() = bad.mesh_hash.back() == '0' ? '1' : '0';
  bad.encoding.bases[0] = 3.0f;
  std::fill(bad.encoding.cluster_of_point.begin(), bad.encoding.cluster_of_point.end(), 0u);
  const Inspection inspection = inspect_file(write_baked(bad));
  EXPECT_TRUE(inspection.valid());  // it can be drawn
  const std::string text = to_text(inspection.json);
  for (const char* part : {"other geometry or colours", "not orthonormal", "1 have no vertex"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  }
  EXPECT_EQ(inspection.json["findings"].size(), 3u);
}

TEST_F(InspectionTest, VectorsOfTransferMatricesAreOrthonormalAsExitRadiance) {
  gltf::PrecomputedTransfer glossy = transfer();
  glossy.row_count = 24;
  const sh::RadianceMetric metric(24, 4);
  std::vector<float> values(8 * 24 * 4);
  Pcg32 random(5);
  for (float& value : values) value = random.uniform() - 0.5f;
  metric.apply(values);
  cpca::Options options;
  options.cluster_count = 1;
  options.component_count = 3;
  glossy.encoding = cpca::encode_static(values, 24 * 4, options).encoding;
  const Inspection plain = inspect_file(write_baked(glossy));  // orthonormal as numbers
  EXPECT_PRED_FORMAT2(testing::IsSubstring, "not orthonormal", to_text(plain.json));
  metric.undo(glossy.encoding.means);
  metric.undo(glossy.encoding.bases);
  const Inspection inspection = inspect_file(write_baked(glossy));
  EXPECT_TRUE(inspection.findings.empty()) << to_text(inspection.json);
  EXPECT_LT(inspection.json["precomputed_transfer"]["orthonormality_error"], 1e-4);
}

TEST_F(InspectionTest, ExamplesOfTheSpecificationAreValid) {
  for (const char* name :
       {"example.gltf", "example_adaptive.gltf", "example_half.gltf", "example_glossy.gltf"}) {
    const Inspection inspection = inspect_file(
        std::filesystem::path("../docs/extensions/PRTKIT_precomputed_transfer") / name);
    EXPECT_TRUE(inspection.valid()) << to_text(inspection.json);
    EXPECT_EQ(inspection.json["precomputed_transfer"]["band_count"], 2);
  }
}

TEST_F(InspectionTest, TruncatedModelIsAFinding) {
  const auto path = write_model();
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  const Inspection inspection = inspect_file(path);
  EXPECT_FALSE(inspection.valid());
  EXPECT_EQ(inspection.json["findings"].size(), 1u);
}

TEST_F(InspectionTest, TransferShowsEnergyPerBand) {
  const Inspection inspection = inspect_file(write_transfer());
  EXPECT_TRUE(inspection.valid());
  const Json& json = inspection.json["transfer"];
  EXPECT_EQ(inspection.json["kind"], "transfer");
  EXPECT_EQ(json["vertex_count"], 8);
  EXPECT_EQ(json["blocks"].size(), 2u);
  double band_0 = 0.0, band_1 = 0.0;
  const auto values = signal().values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    (i % 4 == 0 ? band_0 : band_1) += double{values[i]} * values[i];
  }
  EXPECT_DOUBLE_EQ(json["energy_per_band"][0], band_0);
  EXPECT_DOUBLE_EQ(json["energy_per_band"][1], band_1);
}

TEST_F(InspectionTest, TransferOfThousandsOfChannelsIsTakenForOne) {
  signal::TransferSignal glossy = signal();
  glossy.band_count = 5;
  glossy.row_count = 25;
  glossy.channel_count = 3;
  glossy.values.assign(8 * static_cast<std::size_t>(glossy.dimension()), 1.0f);
  const auto path = folder() / "glossy.transfer.exr";
  signal::write_transfer(path, glossy);
  const Inspection inspection = inspect_file(path);
  EXPECT_EQ(inspection.json["kind"], "transfer");
  EXPECT_EQ(inspection.json["transfer"]["dimension"], 1875);
}

TEST_F(InspectionTest, LightShowsMeanAndRinging) {
  const auto path = folder() / "light.json";
  sh::write_light(path, sh::constant_light(3, Vec3(1.0f, 2.0f, 3.0f)));
  Inspection inspection = inspect_file(path);
  EXPECT_EQ(inspection.json["kind"], "light");
  EXPECT_TRUE(inspection.findings.empty());
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(inspection.json["light"]["mean_radiance"][c].get<double>(), c + 1.0, 1e-5);
  }
  EXPECT_NEAR(inspection.json["light"]["radiance_max"].get<double>(), 3.0, 1e-5);

  const Vec3 up(0.0f, 1.0f, 0.0f);
  sh::write_light(path, sh::directional_light(5, up, Vec3(1.0f)));
  inspection = inspect_file(path);
  EXPECT_TRUE(inspection.valid());
  ASSERT_EQ(inspection.findings.size(), 1u);
  EXPECT_EQ(inspection.findings[0].severity, Severity::warning);
  EXPECT_GT(inspection.json["light"]["brightest_direction"][1].get<double>(), 0.999);
}

TEST_F(InspectionTest, ImageShowsItsChannels) {
  image::Image image(4, 2, 3);
  image.at(3, 1)[2] = 8.0f;
  const auto path = folder() / "image.exr";
  image::write_image(path, image);
  const Inspection inspection = inspect_file(path);
  EXPECT_EQ(inspection.json["kind"], "image");
  EXPECT_EQ(inspection.json["image"]["width"], 4);
  EXPECT_EQ(inspection.json["image"]["channels"][2]["max"], 8.0);
  EXPECT_EQ(inspection.json["image"]["channels"][2]["mean"], 1.0);
}

TEST_F(InspectionTest, RejectsUnknownAndMissingFiles) {
  const auto path = folder() / "notes.txt";
  std::ofstream(path) << "hello";
  EXPECT_THROW(inspect_file(path), Error);
  EXPECT_THROW(inspect_file(folder() / "missing.glb"), Error);
}

TEST_F(InspectionTest, SaysWhatReadsTheArraysThatCompressWrites) {
  const auto path = folder() / "x.npz";
  signal::write_npz(path, std::vector{signal::make_array("a", "<f4", {2}, std::vector{1.f, 2.f})});
  try {
    inspect_file(path);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_TRUE(error.details().advice.starts_with("numpy.load reads")) << error.what();
  }
}

}  // namespace
}  // namespace prt::inspect
