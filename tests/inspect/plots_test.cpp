#include "inspect/plots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <tuple>

#include "core/error.h"
#include "core/random.h"
#include "cpca/encoder.h"
#include "image/false_color.h"
#include "inspect/canvas.h"
#include "inspect/encoding_study.h"
#include "inspect/error_figure.h"
#include "inspect/line_plot.h"
#include "inspect/mesh_picture.h"
#include "sample_files.h"

namespace prt::inspect {
namespace {

/// A row of points of 9 coefficients that change smoothly, with a little noise.
signal::TransferSignal smooth_signal(std::size_t point_count) {
  signal::TransferSignal signal;
  signal.band_count = 3;
  signal.blocks.push_back({"row", point_count});
  Pcg32 random(4);
  for (std::size_t p = 0; p < point_count; ++p) {
    for (int k = 0; k < 9; ++k) {
      signal.values.push_back(std::sin(0.01f * static_cast<float>(k + 1) * static_cast<float>(p)) +
                              0.01f * random.uniform());
    }
  }
  return signal;
}

TEST(EncodingStudy, ErrorsByMethodAreOfTheSameCounts) {
  const signal::TransferSignal signal = smooth_signal(640);
  const auto errors = errors_by_method(signal, encode_iteratively(signal, 8, 2));
  ASSERT_EQ(errors.size(), 3u);
  const char* const names[] = {"static", "iterative", "adaptive"};
  double energy = 0.0;
  for (const float value : signal.values) energy += double{value} * double{value};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(errors[i].name, names[i]);
    ASSERT_EQ(errors[i].relative.size(), 640u);
    double sum = 0.0;
    for (const double error : errors[i].relative) sum += error * error;
    EXPECT_NEAR(sum / 640.0 * energy, errors[i].squared_error, 1e-6 * errors[i].squared_error);
    if (i == 0) continue;
    EXPECT_LT(errors[i].squared_error, errors[i - 1].squared_error);
  }
  EXPECT_NEAR(errors[0].squared_error, error_over_components(signal, 8, 2).series[0].y[2],
              1e-3 * errors[0].squared_error);
}

double static_error(const signal::TransferSignal& signal, int clusters, int components) {
  const auto encoded = cpca::encode_static(
      signal.values, 9, {.cluster_count = clusters, .component_count = components});
  double sum = 0.0;
  for (const double error : cpca::point_errors(encoded.encoding, signal.values)) sum += error;
  return sum;
}

TEST(EncodingStudy, ErrorOverStorageIsThatOfEncodingEachTime) {
  const signal::TransferSignal signal = smooth_signal(640);
  const LinePlot plot = error_over_storage(signal);
  EXPECT_TRUE(plot.title.ends_with("up to 16")) << plot.title;
  ASSERT_EQ(plot.series.size(), 5u);  // n' = 16 is more than there are coefficients
  const int counts[] = {0, 1, 2, 4, 8};
  for (std::size_t s = 0; s < 5; ++s) {
    const Series& series = plot.series[s];
    ASSERT_EQ(series.x.size(), 3u);  // 1, 4, 16 clusters
    int clusters = 1;
    for (std::size_t i = 0; i < 3; ++i, clusters *= 4) {
      EXPECT_EQ(series.x[i], 640 * counts[s] + clusters * (counts[s] + 1) * 9);
      const double expected = static_error(signal, clusters, counts[s]);
      EXPECT_NEAR(series.y[i], expected, 1e-3 * expected + 1e-6);
    }
  }
}

TEST(EncodingStudy, MethodsStartAlikeAndFallWithEveryVector) {
  const signal::TransferSignal signal = smooth_signal(640);
  const LinePlot plot = error_over_components(signal, 8, 5);
  ASSERT_EQ(plot.series.size(), 3u);
  const std::vector<double> all{0, 1, 2, 3, 4, 5}, some{0, 1, 2, 4, 5};
  for (const Series& series : plot.series) {
    EXPECT_EQ(series.x, series.name == "adaptive" ? some : all) << series.name;
    EXPECT_NEAR(series.y[0], plot.series[1].y[0], 1e-2 * series.y[0]) << series.name;
    for (std::size_t i = 1; i < series.y.size(); ++i) {
      EXPECT_LT(series.y[i], series.y[i - 1]) << series.name;
    }
  }
  EXPECT_LT(plot.series[1].y.back(), plot.series[0].y.back());
  // With vectors enough for all clusters next to nothing moves: no worse, but for rounding.
  EXPECT_LT(plot.series[2].y.back(), 1.001 * plot.series[1].y.back());
}

TEST(EncodingStudy, WorkGrowsWithWhatIsEncoded) {
  const StudyWork work = study_work(640, 8, 2, 4);
  EXPECT_GT(study_work(640, 8, 3, 4).iterative, work.iterative);
  EXPECT_GT(study_work(640, 8, 3, 4).methods, work.methods);
  EXPECT_NEAR(study_work(640, 16, 2, 4).storage, work.storage / 2, 1e-9);  // in larger units
  EXPECT_GT(study_work(2560, 8, 2, 4).storage, work.storage);
  EXPECT_GT(study_work(640, 8, 2, 5).components, work.components);
}

TEST(LinePlot, WritesEveryPointAndDrawsItWhereItBelongs) {
  const LinePlot plot{.title = "t",
                      .x_label = "x",
                      .y_label = "y",
                      .series = {{"a", {0, 1, 2}, {1, 0.1, 0.01}}, {"b", {0, 2}, {0, 1}}}};
  EXPECT_EQ(to_csv(plot), "series,x,y\na,0,1\na,1,0.1\na,2,0.01\nb,0,0\nb,2,1\n");
  const image::Image image = draw(plot);
  std::size_t colored_count = 0;
  for (int y = 44; y < 404; ++y) {
    for (int x = 72; x < 632; ++x) {
      const float* const p = image.at(x, y);
      colored_count += std::max({p[0], p[1], p[2]}) > std::min({p[0], p[1], p[2]}) + 0.1f;
    }
  }
  EXPECT_GT(colored_count, 500u);  // a line across the plot and its marks
  EXPECT_NO_THROW(draw({.title = "", .x_label = "", .y_label = "", .series = {}}));
}

TEST(MeshPicture, ShowsTheNearestTriangleInItsColor) {
  mesh::Scene scene;
  for (const float z : {0.0f, 0.5f, -0.5f}) {  // the middle one is drawn first, the far one last
    mesh::Primitive& primitive = scene.primitives.emplace_back();
    primitive.mesh.positions = {{-1, -1, z}, {1, -1, z}, {0, 1, z}};
    primitive.mesh.normals.assign(3, {0, 0, 1});
    primitive.mesh.indices = {0, 1, 2};
  }
  std::vector<Vec3> colors(9, Vec3(0, 1, 0));
  for (std::size_t i = 3; i < 6; ++i) colors[i] = Vec3(1, 0, 0);
  for (const bool smooth : {false, true}) {
    Canvas canvas(64, 64, kBlack);
    draw_surface(canvas, 0, 0, 64, scene, colors, {.is_smooth = smooth});
    const image::Image image = canvas.linear();
    const float* const middle = image.at(32, 36);
    EXPECT_GT(middle[0], 0.5f);
    EXPECT_EQ(middle[1], 0.0f);
    EXPECT_EQ(image.at(1, 1)[1], 1.0f);  // beside: white
  }
}

TEST(MeshPicture, ShowsTheOtherSideFromBehindAndUnshadedTheColorsAsTheyAre) {
  mesh::Scene scene;
  for (const float z : {-0.5f, 0.5f}) {
    mesh::Primitive& primitive = scene.primitives.emplace_back();
    primitive.mesh.positions = {{-1, -1, z}, {1, -1, z}, {0, 1, z}};
    primitive.mesh.normals.assign(3, {0, 0, 1});
    primitive.mesh.indices = {0, 1, 2};
  }
  const std::vector<Vec3> colors{{1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}};
  for (const bool behind : {false, true}) {
    Canvas canvas(64, 64, kBlack);
    draw_surface(canvas, 0, 0, 64, scene, colors,
                 {.is_smooth = true, .is_shaded = false, .is_from_behind = behind});
    const image::Image image = canvas.linear();
    EXPECT_NEAR(image.at(32, 36)[behind ? 0 : 1], 1.0f, 1e-5f);
    EXPECT_NEAR(image.at(32, 36)[behind ? 1 : 0], 0.0f, 1e-5f);
  }
}

TEST(ErrorFigure, ShowsAllEncodingsOnOneScale) {
  mesh::Scene scene;
  mesh::Primitive& primitive = scene.primitives.emplace_back();
  primitive.mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  primitive.mesh.normals.assign(3, {0, 0, 1});
  primitive.mesh.indices = {0, 1, 2};
  const std::vector<EncodingError> errors{{"a", 3.5, {0.2, 0.2, 0.2}},
                                          {"b", 1.25, {0.1, 0.1, 0.1}}};
  EXPECT_EQ(to_csv(errors), "vertex,a,b\n0,0.2,0.1\n1,0.2,0.1\n2,0.2,0.1\n");
  const image::Image image = draw(scene, errors, "title");
  const auto count = [&](const Vec3& color, int from, int to) {
    Canvas canvas(1, 1, color);
    const image::Image sample = canvas.linear();
    std::size_t found = 0;
    for (int y = 64; y < 64 + 680; ++y) {
      for (int x = from; x < to; ++x) {
        float difference = 0.0f;
        for (int c = 0; c < 3; ++c) {
          difference += std::abs(image.at(x, y)[c] - sample.at(0, 0)[c]);
        }
        found += difference < 1e-4f;
      }
    }
    return found;
  };
  const int middle = image.width / 2;
  for (const auto& [t, from, to] :
       {std::tuple(1.0f, 0, middle), std::tuple(0.5f, middle, image.width)}) {
    EXPECT_GT(count(image::heat_color(t), from, to), 2 * 10000u) << t;  // from two sides
    EXPECT_EQ(count(image::heat_color(1.5f - t), from, to), 0u) << t;
  }
}

class PlotsTest : public SampleFiles {};

std::vector<std::string> names_of(const std::vector<Plot>& plots) {
  std::vector<std::string> names;
  for (const Plot& plot : plots) {
    names.push_back(plot.name);
    EXPECT_GT(plot.image.pixel_count(), 10000u) << plot.name;
    EXPECT_GT(plot.csv.size(), 20u) << plot.name;
  }
  return names;
}

TEST_F(PlotsTest, AreThoseThatAreAnnounced) {
  const auto model = write_baked(transfer());
  std::vector<std::string> names = names_of(plots_of_model(model));
  EXPECT_EQ(names, (std::vector<std::string>{"clusters", "superclusters", "vector-variance"}));
  testing::internal::CaptureStderr();
  for (const std::string& name : names_of(plots_of_compression(model, write_transfer()))) {
    names.push_back(name);
  }
  EXPECT_NE(testing::internal::GetCapturedStderr().find("encoding the transfer anew"),
            std::string::npos);
  names.insert(names.begin() + 3, "vectors");  // of adaptive ones
  EXPECT_EQ(names, plot_names(true));
  EXPECT_THROW(plots_of_model(write_model()), Error);
}

TEST_F(PlotsTest, ShowTheVectorsOfAdaptiveEncodings) {
  gltf::PrecomputedTransfer adaptive = transfer();
  cpca::Encoding& encoding = adaptive.encoding;
  encoding.component_counts.assign(static_cast<std::size_t>(encoding.cluster_count),
                                   static_cast<std::uint32_t>(encoding.component_count));
  const std::vector<Plot> plots = plots_of_model(write_baked(adaptive));
  EXPECT_EQ(names_of(plots), plot_names(false));
  EXPECT_TRUE(plots[3].csv.starts_with("cluster,vectors\n0,")) << plots[3].csv;
}

TEST(TransferBeside, IsFoundByTheNameOfTheModel) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "beside";
  std::filesystem::create_directories(folder);
  EXPECT_EQ(transfer_beside(folder / "a.prt.glb"), "");
  std::ofstream(folder / "a.transfer.exr") << "x";
  for (const char* name : {"a.prt.glb", "a.glb", "a.prt.gltf"}) {
    EXPECT_EQ(transfer_beside(folder / name), folder / "a.transfer.exr") << name;
  }
  EXPECT_EQ(transfer_beside(folder / "b.prt.glb"), "");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace prt::inspect
