// The viewer with a real window: run under xvfb-run.
#include "runtime/viewer.h"

#include <gtest/gtest.h>

// GLFW's functions alone: OpenGL is the library's.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>

#include "core/error.h"
#include "gltf/document.h"
#include "image/false_color.h"
#include "runtime/glossy_models.h"

namespace prt::runtime {
namespace {

namespace fs = std::filesystem;

class ViewerTest : public testing::Test {
 protected:
  ViewerTest() {
    fs::create_directories(folder_);
    const mesh::Scene scene = scene_of({torus(40, 20)});
    signal_ = unshadowed(scene, 3, {{1, 0, 0}});
    signal_.mesh_hash = mesh::mesh_hash(scene);
    gltf::PrecomputedTransfer transfer = full_rank(signal_, 5);
    transfer.mesh_hash = signal_.mesh_hash;
    gltf::Document document = gltf::Document::from_scene(scene);
    document.save_glb(path("unbaked.glb"));
    document.set_precomputed_transfer(transfer);
    document.save_glb(path("good.glb"));
    gltf::PrecomputedTransfer one_band = random_transfer(scene.vertex_count(), 1, 1, 2, 1);
    one_band.mesh_hash = transfer.mesh_hash;
    document.set_precomputed_transfer(one_band);
    document.save_glb(path("one_band.glb"));
    std::ofstream(path("bad.glb")) << "glTF, but not really";
    std::ofstream(path("bad.json")) << "{";
    sh::write_light(path("good.json"), test_light(3));
    options_.model = path("good.glb");
    options_.screenshot = path("shot.png");
    options_.panel = false;
    options_.width = 320;
    options_.height = 240;
  }
  ~ViewerTest() override { fs::remove_all(folder_); }
  fs::path path(const std::string& name) const { return folder_ / name; }

  /// Pixels in which two windows without the panel differ: what one model or light adds to the
  /// other.
  std::size_t changed_pixel_count(const fs::path& a, const fs::path& b) const {
    const image::Image first = image::read_image(a), second = image::read_image(b);
    EXPECT_EQ(first.pixels.size(), second.pixels.size());
    std::size_t count = 0;
    for (int y = 0; y < first.height; ++y)
      for (int x = 0; x < first.width; ++x)
        count += std::abs(first.at(x, y)[0] - second.at(x, y)[0]) > 0.01f;
    return count;
  }
  fs::path empty_window() {
    ViewerOptions options = options_;
    options.model.clear();
    options.transfer.clear();
    options.screenshot = path("empty.png");
    Viewer(options).run();
    return options.screenshot;
  }

  fs::path folder_ = fs::path(testing::TempDir()) / "prtkit_viewer";
  signal::TransferSignal signal_;
  ViewerOptions options_;
};

TEST_F(ViewerTest, WritesAScreenshotAndEnds) {
  EXPECT_GT(Viewer(options_).run(), 0.0);
  const image::Image image = image::read_image(options_.screenshot);
  EXPECT_EQ(image.width, 320);
  EXPECT_EQ(image.height, 240);
  EXPECT_GT(changed_pixel_count(options_.screenshot, empty_window()), 10000u);
}

TEST_F(ViewerTest, PanelStandsBesideTheModel) {
  Viewer(options_).run();
  ViewerOptions with_panel = options_;
  with_panel.panel = true;
  with_panel.screenshot = path("panel.png");
  Viewer(with_panel).run();
  EXPECT_GT(changed_pixel_count(options_.screenshot, with_panel.screenshot), 2000u);
}

TEST_F(ViewerTest, LightTurnsWhenAskedAndLampsNearTheModelShine) {
  Viewer(options_).run();
  ViewerOptions other = options_;
  other.screenshot = path("other.png");
  other.animate = true;
  other.screenshot_frame_count = 40;
  Viewer(other).run();
  EXPECT_GT(changed_pixel_count(options_.screenshot, other.screenshot), 100u);
  other.animate = false;
  other.near_lights.push_back({Vec3(2, 1, 2), 0.3f, Vec3(20)});
  Viewer(other).run();
  EXPECT_GT(changed_pixel_count(options_.screenshot, other.screenshot), 1000u);
}

TEST_F(ViewerTest, MapIsProjectedAgainForAModelOfMoreBands) {
  image::write_image(path("map.exr"), lighting_from(test_light(3)).environment);
  options_.light = path("map.exr");
  Viewer(options_).run();
  ViewerOptions dropped = options_;
  dropped.model = path("one_band.glb");
  dropped.screenshot = path("dropped.png");
  Viewer viewer(dropped);
  viewer.open(path("good.glb"));
  EXPECT_EQ(viewer.message(), "");
  viewer.run();
  EXPECT_EQ(changed_pixel_count(options_.screenshot, dropped.screenshot), 0u);
}

TEST_F(ViewerTest, BadDropsLeaveAMessageAndTheModel) {
  auto viewer = std::make_unique<Viewer>(options_);  // one window at a time
  for (const char* name : {"bad.glb", "unbaked.glb", "bad.json", "missing.exr", "missing.glb"}) {
    viewer->open(path(name));
    EXPECT_NE(viewer->message().find(name), std::string::npos) << viewer->message();
  }
  viewer->open(path("good.json"));
  EXPECT_EQ(viewer->message(), "");
  viewer->open(path("good.glb"));
  EXPECT_EQ(viewer->message(), "");
  viewer->run();
  viewer.reset();
  const fs::path after = path("after.png");
  fs::rename(options_.screenshot, after);
  options_.light = path("good.json");
  Viewer(options_).run();
  EXPECT_EQ(changed_pixel_count(options_.screenshot, after), 0u);
  options_.light.clear();
  EXPECT_GT(changed_pixel_count(after, empty_window()), 10000u);
}

TEST_F(ViewerTest, DroppedTransferIsCheckedAgainstTheModel) {
  Viewer viewer(options_);
  for (std::size_t block = 0; block < signal_.blocks.size(); ++block)
    signal_.blocks[block].name = "torus";
  signal::write_transfer(path("good.transfer.exr"), signal_);
  char& digit = signal_.mesh_hash.back();
  digit = digit == '0' ? '1' : '0';
  signal::write_transfer(path("other.transfer.exr"), signal_);
  viewer.open(path("other.transfer.exr"));
  EXPECT_NE(viewer.message().find("other.transfer.exr"), std::string::npos) << viewer.message();
  viewer.open(path("good.transfer.exr"));
  EXPECT_EQ(viewer.message(), "");
  fs::rename(path("good.transfer.exr"), path("GOOD.TRANSFER.EXR"));
  viewer.open(path("GOOD.TRANSFER.EXR"));
  EXPECT_EQ(viewer.message(), "");
}

TEST_F(ViewerTest, BadFilesOnTheCommandLineAreErrors) {
  options_.model = path("bad.glb");
  EXPECT_THROW(Viewer{options_}, Error);
  options_.model = path("good.glb");
  options_.light = path("bad.json");
  EXPECT_THROW(Viewer{options_}, Error);
}

TEST_F(ViewerTest, GlossyModelStandsBesideItsUncompressedTransfer) {
  const mesh::Scene scene = scene_of({torus(40, 20)});
  signal::TransferSignal signal = passing_on(scene, 3);
  gltf::PrecomputedTransfer transfer = in_pairs(signal);
  signal.mesh_hash = transfer.mesh_hash = mesh::mesh_hash(scene);
  signal.brdf = transfer.brdf = "phong:10";
  signal::write_transfer(path("glossy.transfer.exr"), signal);
  gltf::Document document = gltf::Document::from_scene(scene);
  document.set_precomputed_transfer(transfer);
  document.save_glb(path("exact.glb"));
  for (float& weight : transfer.encoding.weights) weight *= 0.5f;
  document.set_precomputed_transfer(transfer);
  document.save_glb(path("coarse.glb"));

  options_.transfer = path("glossy.transfer.exr");
  const auto show = [&](const char* model, Draw draw, const char* picture) {
    options_.model = path(model);
    options_.draw = draw;
    options_.screenshot = path(picture);
    Viewer viewer(options_);
    viewer.run();
    return viewer.model_text();
  };
  const std::string exact = show("exact.glb", Draw::single, "exact.png");
  EXPECT_NE(exact.find("phong:10, 3 bands, 9 exit rows, one pass"), std::string::npos) << exact;
  EXPECT_NE(exact.find("error of the compression: 0.00%"), std::string::npos) << exact;
  const std::string coarse = show("coarse.glb", Draw::single, "coarse.png");
  EXPECT_NE(coarse.find("error of the compression: "), std::string::npos) << coarse;
  EXPECT_EQ(coarse.find("0.00%"), std::string::npos) << coarse;
  show("exact.glb", Draw::uncompressed, "uncompressed.png");
  EXPECT_EQ(changed_pixel_count(path("exact.png"), path("uncompressed.png")), 0u);
  EXPECT_GT(changed_pixel_count(path("coarse.png"), path("uncompressed.png")), 1000u);
  EXPECT_GT(changed_pixel_count(path("exact.png"), empty_window()), 10000u);
}

TEST_F(ViewerTest, WhatTheFilesCannotShowIsAnError) {
  options_.draw = Draw::uncompressed;
  EXPECT_THROW(Viewer{options_}, Error);
  options_.draw = Draw::single;
  options_.show = Show::error;
  EXPECT_THROW(Viewer{options_}, Error);
  signal_.blocks.front().name = "torus";
  signal::write_transfer(path("good.transfer.exr"), signal_);
  options_.transfer = path("good.transfer.exr");
  EXPECT_NO_THROW(Viewer{options_});
  options_.model.clear();
  EXPECT_THROW(Viewer{options_}, Error);
}

/// Pixels that have the heat map's colour of a relative error.
std::size_t count_of(const image::Image& image, float error) {
  const Vec3 color = image::heat_color(error / kErrorScale);
  std::size_t count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float* p = image.at(x, y);
      count += (Vec3(p[0], p[1], p[2]) - color).length() < 0.05f;
    }
  return count;
}

TEST_F(ViewerTest, PanelHasTheColoursOfTheErrorHeatMap) {
  signal_.blocks.front().name = "torus";
  signal::write_transfer(path("good.transfer.exr"), signal_);
  options_.transfer = path("good.transfer.exr");
  options_.show = Show::error;
  const auto shot = [&] {
    Viewer(options_).run();
    return image::read_image(options_.screenshot);
  };
  const image::Image bare = shot();
  options_.panel = true;
  const image::Image with_panel = shot();
  EXPECT_GT(count_of(bare, 0.0f), 10000u);  // the compression is exact
  for (const float error : {0.025f, 0.05f, 0.075f, 0.1f}) {
    EXPECT_EQ(count_of(bare, error), 0u) << error;
    EXPECT_GT(count_of(with_panel, error), 10u) << error;
  }
}

/// Closes the window after a while, as its user would.
class LateClose {
 public:
  explicit LateClose(std::chrono::milliseconds after)
      : thread_([after, window = glfwGetCurrentContext()] {
          std::this_thread::sleep_for(after);
          glfwSetWindowShouldClose(window, GLFW_TRUE);
          glfwPostEmptyEvent();
        }) {}
  ~LateClose() { thread_.join(); }

 private:
  std::thread thread_;
};

TEST_F(ViewerTest, DrawsNothingWhileNothingMoves) {
  options_.screenshot.clear();
  const auto frame_count = [&](bool animate) {
    options_.animate = animate;
    Viewer viewer(options_);
    const LateClose close(std::chrono::milliseconds(1000));
    viewer.run();
    return viewer.frame_count();
  };
  const std::size_t idle = frame_count(false), moving = frame_count(true);
  EXPECT_GE(idle, 3u);
  EXPECT_LT(2 * idle, moving);
}

TEST_F(ViewerTest, TimesWhatFollowsFromTheLight) {
  Viewer viewer(options_);
  EXPECT_EQ(viewer.light_change_milliseconds(), 0.0);  // it is not worked on before a frame
  viewer.run();
  EXPECT_GT(viewer.light_change_milliseconds(), 0.0);
}

TEST_F(ViewerTest, OpensWithoutAModel) {
  options_.model.clear();
  Viewer viewer(options_);
  viewer.run();
  EXPECT_TRUE(fs::exists(options_.screenshot));
}

}  // namespace
}  // namespace prt::runtime
