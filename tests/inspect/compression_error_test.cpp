#include "inspect/compression_error.h"

#include <cmath>

#include "core/error.h"
#include "sample_files.h"

namespace prt::inspect {
namespace {

class CompressionErrorTest : public SampleFiles {};

TEST_F(CompressionErrorTest, SumsSquaredErrorPerMeshAndInTotal) {
  const CompressionError error = compression_error(write_baked(transfer()), write_transfer());
  double energy = 0.0;
  for (const float value : signal().values) energy += double{value} * value;
  EXPECT_DOUBLE_EQ(error.json["squared_error"], 0.25);
  EXPECT_DOUBLE_EQ(error.json["signal_energy"], energy);
  EXPECT_DOUBLE_EQ(error.json["relative_rmse"], std::sqrt(0.25 / energy));
  EXPECT_EQ(error.json["worst_vertex"], 7);
  EXPECT_DOUBLE_EQ(error.json["vertex_error"]["max"], 0.5 / std::sqrt(energy / 8.0));
  EXPECT_EQ(error.json["vertex_error"]["p50"], 0.0);
  EXPECT_EQ(error.json["primitives"][0]["squared_error"], 0.0);
  EXPECT_EQ(error.json["primitives"][1]["name"], "right");
  EXPECT_EQ(error.json["primitives"][1]["worst_vertex"], 3);
  ASSERT_EQ(error.relative.size(), 8u);
}

TEST_F(CompressionErrorTest, RejectsModelsWithoutTransferAndOtherShapes) {
  EXPECT_THROW(compression_error(write_model(), write_transfer()), Error);
  gltf::PrecomputedTransfer one_band = transfer();
  one_band.band_count = 1;
  one_band.encoding.dimension = 1;
  one_band.encoding.means.resize(2);
  one_band.encoding.bases.resize(2);
  EXPECT_THROW(compression_error(write_baked(one_band), write_transfer()), Error);
}

}  // namespace
}  // namespace prt::inspect
