// Exit values that are kept while the light stays.
#include <gtest/gtest.h>

#include "runtime/every_api.h"
#include "runtime/glossy_models.h"
#include "runtime/renderer.h"

namespace prt::runtime {
namespace {

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

}  // namespace
}  // namespace prt::runtime
