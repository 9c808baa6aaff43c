// A picture whose tracing was interrupted, and goes on.
#include <gtest/gtest.h>

#include "core/file.h"
#include "reference/path_tracer.h"
#include "scenes.h"
#include "temporary_folder.h"

namespace prt::reference {
namespace {

TEST(ReferenceResume, GivesTheSamePictureFromAnyPoint) {
  mesh::Scene scene;
  const int white = add_material(scene, Vec3(0.8f));
  add_quad(scene, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}, white);
  add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, white);
  const BandLimitedIllumination light([] {
    sh::Light constant(2);
    for (auto& channel : constant.coefficients) channel = {3.5f, 0.5f, 0.0f, 0.0f};
    return constant;
  }());
  const auto camera = look({0.5f, 2.0f, 2.5f}, {0.5f, 0.3f, 0.3f}, 35.0f);
  const TemporaryFolder folder;
  const auto path = folder / "out.partial";
  Options options;
  options.width = 100;  // tiles of 32 pixels, some of them cut off
  options.height = 70;
  options.sample_count = 4;
  options.bounce_count = 1;
  const Result expected = trace(scene, camera, light, options);
  EXPECT_EQ(expected.resumed_share, 0.0);

  options.checkpoint = {path, 0.0};
  trace(scene, camera, light, options);
  const std::string kept = read_text_file(path);
  double share = 0.0;
  for (std::size_t step = 0; step <= 4; ++step) {
    folder.write("out.partial", kept.substr(0, kept.size() * step / 4));
    const Result result = trace(scene, camera, light, options);
    EXPECT_EQ(result.radiance.pixels, expected.radiance.pixels);
    EXPECT_EQ(result.standard_error.pixels, expected.standard_error.pixels);
    EXPECT_GE(result.resumed_share, share);
    share = result.resumed_share;
  }
  EXPECT_EQ(share, 1.0);

  for (const auto& change : std::vector<std::function<void(Options&, camera::Camera&)>>{
           [](Options&o, camera::Camera&) { o.seed = 2; },
           [](Options&o, camera::Camera&) { o.sample_count = 6; },
           [](Options&o, camera::Camera&) { o.illumination_key = "another"; },
           [](Options&, camera::Camera&c) { c.vertical_fov = 36.0f; }}) {
    folder.write("out.partial", kept);
    Options other = options;
    camera::Camera view = camera;
    change(other, view);
    EXPECT_EQ(trace(scene, view, light, other).resumed_share, 0.0);
  }
}

}  // namespace
}  // namespace prt::reference
