// The viewer with a real window: run under xvfb-run.
#include "runtime/viewer.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "gltf/document.h"
#include "runtime/models.h"

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
    std::ofstream(path("bad.glb")) << "glTF, but not really";
    std::ofstream(path("bad.json")) << "{";
    sh::write_light(path("good.json"), test_light(3));
    options_.model = path("good.glb");
    options_.screenshot = path("shot.png");
    options_.width = 320;
    options_.height = 240;
  }
  ~ViewerTest() override { fs::remove_all(folder_); }
  fs::path path(const std::string& name) const { return folder_ / name; }

  fs::path folder_ = fs::path(testing::TempDir()) / "prtkit_viewer";
  signal::TransferSignal signal_;
  ViewerOptions options_;
};

/// Pixels whose colour varies are the model's and the panel's; a blank window has none.
std::size_t colorful_pixel_count(const fs::path& path) {
  const image::Image image = image::read_image(path);
  std::size_t count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 1; x < image.width; ++x)
      count += std::abs(image.at(x, y)[0] - image.at(x - 1, y)[0]) > 1e-3f;
  return count;
}

TEST_F(ViewerTest, WritesAScreenshotAndEnds) {
  Viewer viewer(options_);
  EXPECT_GT(viewer.run(), 0.0);
  const image::Image image = image::read_image(options_.screenshot);
  EXPECT_EQ(image.width, 320);
  EXPECT_EQ(image.height, 240);
  EXPECT_GT(colorful_pixel_count(options_.screenshot), 2000u);
}

TEST_F(ViewerTest, BadDropsLeaveAMessageAndTheModel) {
  Viewer viewer(options_);
  for (const char* name : {"bad.glb", "unbaked.glb", "bad.json", "missing.exr", "missing.glb"}) {
    viewer.open(path(name));
    EXPECT_NE(viewer.message().find(name), std::string::npos) << viewer.message();
  }
  viewer.open(path("good.json"));
  EXPECT_EQ(viewer.message(), "");
  viewer.open(path("good.glb"));
  EXPECT_EQ(viewer.message(), "");
  viewer.run();
  EXPECT_GT(colorful_pixel_count(options_.screenshot), 2000u);
}

TEST_F(ViewerTest, DroppedTransferIsCheckedAgainstTheModel) {
  Viewer viewer(options_);
  for (std::size_t block = 0; block < signal_.blocks.size(); ++block)
    signal_.blocks[block].name = "torus";
  signal::write_transfer(path("good.transfer.exr"), signal_);
  signal_.mesh_hash = std::string(32, '0');
  signal::write_transfer(path("other.transfer.exr"), signal_);
  viewer.open(path("other.transfer.exr"));
  EXPECT_NE(viewer.message().find("other.transfer.exr"), std::string::npos) << viewer.message();
  viewer.open(path("good.transfer.exr"));
  EXPECT_EQ(viewer.message(), "");
}

TEST_F(ViewerTest, BadFilesOnTheCommandLineAreErrors) {
  options_.model = path("bad.glb");
  EXPECT_THROW(Viewer{options_}, Error);
  options_.model = path("good.glb");
  options_.light = path("bad.json");
  EXPECT_THROW(Viewer{options_}, Error);
}

TEST_F(ViewerTest, OpensWithoutAModel) {
  options_.model.clear();
  Viewer viewer(options_);
  viewer.run();
  EXPECT_TRUE(fs::exists(options_.screenshot));
}

}  // namespace
}  // namespace prt::runtime
