// Pictures by every OpenGL that the runtime draws with.
#pragma once

#include <gtest/gtest.h>

#include "gl/context.h"
#include "runtime/models.h"
#include "runtime/pictures.h"

namespace prt::runtime {

/// To be derived from, one suite for each subject.
class EveryApi : public testing::TestWithParam<gl::Api> {
 protected:
  gl::HeadlessContext context_{{.api = GetParam()}};
  Renderer renderer_;

  image::Image render(const Model& model, Draw draw, const Lighting& lighting, int samples = 1,
                      Sums sums = Sums::kept) {
    View view = view_of(model);
    view.draw = draw;
    view.sums = sums;
    renderer_.set_model(model);
    renderer_.set_lighting(lighting);
    return renderer_.render(view, kWidth, kHeight, samples);
  }
};

inline auto every_api() { return testing::Values(gl::Api::core_3_3, gl::Api::es_3_0); }

}  // namespace prt::runtime
