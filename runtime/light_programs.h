// Shaders for light that is the same everywhere, and for light that varies over the model
// (runtime/light_field.h), each compiled when it is first needed.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <utility>

#include "gl/program.h"
#include "runtime/light_field.h"

namespace prt::runtime {

class LightPrograms {
 public:
  using Make = std::function<gl::Program(bool varies)>;

  LightPrograms() = default;
  explicit LightPrograms(Make make) : make_(std::move(make)) {}

  const gl::Program& of(bool varies) const {
    std::optional<gl::Program>& program = programs_[varies];
    if (!program) program = make_(varies);
    return *program;
  }

 private:
  Make make_;
  mutable std::array<std::optional<gl::Program>, 2> programs_;
};

}  // namespace prt::runtime
