// Exit values that are kept while the light stays.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "runtime/every_api.h"
#include "runtime/exit_buffer.h"
#include "runtime/glossy_models.h"
#include "runtime/renderer.h"

namespace prt::runtime {
namespace {

/// While it lives, the process can take no more than so many bytes.
class LittleMemory {
 public:
  explicit LittleMemory(std::size_t more) {
    getrlimit(RLIMIT_AS, &before_);
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit now = before_;
    now.rlim_cur = pages * static_cast<std::size_t>(getpagesize()) + more;
    setrlimit(RLIMIT_AS, &now);
  }
  ~LittleMemory() { setrlimit(RLIMIT_AS, &before_); }
  LittleMemory(const LittleMemory&) = delete;
  LittleMemory& operator=(const LittleMemory&) = delete;

 private:
  rlimit before_{};
};

class KeptSums : public EveryApi {};
INSTANTIATE_TEST_SUITE_P(Renderer, KeptSums, every_api());

TEST_P(KeptSums, AreThoseOfEveryFrame) {
  const mesh::Scene scene = scene_of({torus(60, 30)});
  const Lighting lighting = lighting_from(test_light(3));
  for (const auto& transfer : {random_transfer(scene.vertex_count(), 3, 3, 40, 0),
                               random_transfer(scene.vertex_count(), 3, 1, 40, 7),
                               random_adaptive_transfer(scene.vertex_count(), 3, 3, 40, 7)}) {
    const Model model = make_model(scene, transfer, decompressed(transfer));
    for (const Draw draw : {Draw::single, Draw::uncompressed})
      EXPECT_LT(largest_difference(render(model, draw, lighting, 1, Sums::kept),
                                   render(model, draw, lighting, 1, Sums::every_frame)),
                1e-4f);
  }
}

TEST_P(KeptSums, FollowTheLight) {
  const mesh::Scene scene = scene_of({torus(60, 30)});
  const auto transfer = random_transfer(scene.vertex_count(), 3, 3, 40, 7);
  const Model model = make_model(scene, transfer, decompressed(transfer));
  renderer_.set_model(model);
  renderer_.set_lighting(lighting_from(test_light(3)));
  for (const Draw draw : {Draw::single, Draw::uncompressed}) {
    View view = view_of(model);
    view.draw = draw;
    const auto render = [&](float degrees, Sums sums) {
      view.sums = sums;
      renderer_.set_light_rotation(light_rotation(degrees));
      return renderer_.render(view, kWidth, kHeight, 1);
    };
    const image::Image before = render(0, Sums::kept), after = render(90, Sums::kept);
    EXPECT_GT(largest_difference(before, after), 0.1f);
    EXPECT_LT(largest_difference(after, render(90, Sums::every_frame)), 1e-4f);
    EXPECT_EQ(largest_difference(before, render(0, Sums::kept)), 0.0f);
  }
}

TEST_P(KeptSums, AreNotNeeded) {
  const mesh::Scene scene = scene_of({torus(60, 30)});
  const auto transfer = random_transfer(scene.vertex_count(), 3, 3, 40, 7);
  const Model model = make_model(scene, transfer, decompressed(transfer));
  for (const Draw draw : {Draw::single, Draw::uncompressed}) {
    const image::Image expected = render(model, draw, lighting_from(test_light(3)));
    renderer_.set_model(model, {.keep_sums = false});
    View view = view_of(model);
    view.draw = draw;
    EXPECT_LT(largest_difference(expected, renderer_.render(view, kWidth, kHeight, 1)), 1e-4f);
  }
}

TEST_P(KeptSums, WithoutRoomAreSumsOfEveryFrameAndOneWarning) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "its malloc ends the process";
#endif
  // 24 rows: 288 bytes a vertex, twice.
  const mesh::Scene scene = scene_of({with_random_tangents(torus(500, 400))});
  const auto transfer = random_transfer(scene.vertex_count(), 1, 1, 5, 1, 24);
  const Model model = make_model(scene, transfer, {});
  const image::Image expected =
      render(model, Draw::single, lighting_from(test_light(1)), 1, Sums::every_frame);
  View view = view_of(model);
  testing::internal::CaptureStderr();
  {
    const LittleMemory little(std::size_t{32} << 20);
    for (int frame = 0; frame < 2; ++frame)
      EXPECT_EQ(largest_difference(expected, renderer_.render(view, kWidth, kHeight, 1)), 0.0f);
  }
  const std::string said = testing::internal::GetCapturedStderr();
  const std::size_t at = said.find("no room to keep what 200000 vertices send");
  EXPECT_NE(at, std::string::npos) << said;
  EXPECT_EQ(said.find("no room", at + 1), std::string::npos) << said;
}

TEST_P(KeptSums, FitWhatOpenGlHolds) {
  const ExitLayout layout = exit_layout(24, 3);
  EXPECT_TRUE(ExitBuffer::fits(layout, 100000));
  EXPECT_FALSE(ExitBuffer::fits(layout, std::size_t{1} << 32));
}

}  // namespace
}  // namespace prt::runtime
