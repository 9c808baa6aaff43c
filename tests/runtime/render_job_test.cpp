// Options and files of a picture, before anything is drawn.
#include "runtime/render_job.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <limits>

#include "core/error.h"
#include "gltf/document.h"
#include "runtime/models.h"
#include "runtime/picture.h"
#include "runtime/reference/reference_job.h"

namespace prt::runtime {
namespace {

namespace fs = std::filesystem;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

ErrorKind kind_of_error(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.kind();
  }
  ADD_FAILURE() << "no error";
  return ErrorKind::failed;
}

class RenderJobTest : public testing::Test {
 protected:
  RenderJobTest() { fs::create_directories(folder_); }
  ~RenderJobTest() override { fs::remove_all(folder_); }
  fs::path path(const char* name) const { return folder_ / name; }

  fs::path folder_ = fs::path(testing::TempDir()) / "prtkit_render_job";
};

TEST_F(RenderJobTest, NumbersThatMakeNoPictureAreWrongUsage) {
  EXPECT_NO_THROW(check_options({.light_rotation = 720.0f, .exposure = -64.0f}));
  for (const PictureOptions& options :
       {PictureOptions{.exposure = kNan}, PictureOptions{.exposure = 200.0f},
        PictureOptions{.light_rotation = kInfinity},
        PictureOptions{.background_color = Vec3(0.0f, kNan, 0.0f)}})
    EXPECT_EQ(kind_of_error([&] { check_options(options); }), ErrorKind::usage);
}

TEST_F(RenderJobTest, BandsGoWithMapsNotWithLightFiles) {
  EXPECT_NO_THROW(check_options({.light = "map.exr", .band_count = 4}));
  EXPECT_EQ(kind_of_error([] { check_options({.light = "light.json", .band_count = 4}); }),
            ErrorKind::usage);
}

TEST_F(RenderJobTest, LightOfMoreBandsThanTheTransferIsCutBehindTheModelToo) {
  const sh::Light light = test_light(6);
  sh::write_light(path("light.json"), light);
  const PictureOptions options{.light = path("light.json")};
  Report report("prt-render");
  const Lighting cut = make_lighting(options, 3, report);
  EXPECT_EQ(cut.light.band_count, 3);
  EXPECT_EQ(cut.environment.pixels,
            lighting_from(sh::with_band_count(light, 3)).environment.pixels);
  EXPECT_EQ(make_lighting(options, 0, report).light.band_count, 6);
  EXPECT_EQ(make_lighting({}, 3, report).light.band_count, 3);
}

TEST_F(RenderJobTest, CompressedTransferOfAnotherMeshIsDrawnWithAWarning) {
  const mesh::Scene scene = scene_of({torus(20, 10)});
  gltf::PrecomputedTransfer transfer = random_transfer(scene.vertex_count(), 2, 1, 3, 2);
  gltf::Document document = gltf::Document::from_scene(scene);
  transfer.mesh_hash = mesh::mesh_hash(scene);
  document.set_precomputed_transfer(transfer);
  document.save_glb(path("own.glb"));
  const auto said_of = [&](const char* name) {
    testing::internal::CaptureStderr();
    EXPECT_TRUE(load_model(path(name)).transfer.has_value());
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(said_of("own.glb"), "");
  mesh::Scene other = scene;  // as many vertices
  other.primitives[0].mesh.positions[7].x += 0.1f;
  transfer.mesh_hash = mesh::mesh_hash(other);
  document.set_precomputed_transfer(transfer);
  document.save_glb(path("other.glb"));
  const std::string said = said_of("other.glb");
  EXPECT_NE(said.find("baked for other geometry or colours"), said.npos) << said;
  transfer.mesh_hash = "3df243d100d3cbc776a45bc90316d2fe";  // as older versions wrote them
  document.set_precomputed_transfer(transfer);
  document.save_glb(path("old.glb"));
  EXPECT_EQ(said_of("old.glb"), "");
}

TEST_F(RenderJobTest, ExamplesOfTheSpecificationAreDrawn) {
  for (const char* name : {"example.gltf", "example_adaptive.gltf", "example_glossy.gltf"}) {
    RenderOptions options;
    options.picture.model = fs::path("../docs/extensions/PRTKIT_precomputed_transfer") / name;
    options.picture.output = path("example.exr");
    options.picture.width = options.picture.height = 40;
    options.picture.background = Background::none;
    Report report("test");
    render(options, report);
    const image::Image picture = image::read_image(path("example.exr"));
    std::size_t covered_count = 0;
    for (std::size_t i = 3; i < picture.pixels.size(); i += 4)
      covered_count += picture.pixels[i] == 1.0f;
    EXPECT_GT(covered_count, 100u) << name;
  }
}

TEST_F(RenderJobTest, EndingsInCapitalsSayTheSame) {
  image::Image linear(1, 1, 4);
  linear.pixels = {4.0f, 5.0f, 6.0f, 1.0f};
  write_picture(path("LINEAR.EXR"), linear, {}, false);
  EXPECT_EQ(image::read_image(path("LINEAR.EXR")).pixels, linear.pixels);
  sh::write_light(path("LIGHT.JSON"), test_light(2));
  EXPECT_FALSE(load_lighting(path("LIGHT.JSON"), 5).is_full_map);
}

TEST_F(RenderJobTest, ReferenceHasTheSameBackground) {
  const mesh::Scene scene = scene_of({torus(20, 10)});
  gltf::PrecomputedTransfer transfer = random_transfer(scene.vertex_count(), 2, 1, 3, 2);
  transfer.mesh_hash = mesh::mesh_hash(scene);
  gltf::Document document = gltf::Document::from_scene(scene);
  document.set_precomputed_transfer(transfer);
  document.save_glb(path("model.glb"));
  sh::write_light(path("light.json"), test_light(4));
  image::write_image(path("map.exr"), lighting_from(test_light(6)).environment);
  for (const char* light : {"", "light.json", "map.exr"}) {
    RenderOptions options;
    options.sample_count = 1;
    options.picture.model = path("model.glb");
    options.picture.output = path("drawn.exr");
    if (*light != 0) options.picture.light = path(light);
    options.picture.light_rotation = 100.0f;
    options.picture.width = 80;
    options.picture.height = 60;
    Report report("test");
    render(options, report);
    ReferenceOptions reference{.picture = options.picture, .sample_count = 2, .box_filter = false};
    reference.picture.output = path("traced.exr");
    render_reference(reference, report);
    const image::Image drawn = image::read_image(path("drawn.exr"));
    const image::Image traced = image::read_image(path("traced.exr"));
    std::size_t background_count = 0;
    for (std::size_t i = 0; i < drawn.pixels.size(); i += 4) {
      if (drawn.pixels[i + 3] != 0.0f || traced.pixels[i + 3] != 0.0f) continue;
      ++background_count;
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_NEAR(drawn.pixels[i + c], traced.pixels[i + c], 2e-3f) << light;
    }
    EXPECT_GT(background_count, 1000u);
  }
}

}  // namespace
}  // namespace prt::runtime
