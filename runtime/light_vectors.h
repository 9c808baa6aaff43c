// The light of uncompressed transfer as shaders/light_vectors.glsl reads it.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "gl/objects.h"
#include "gl/program.h"
#include "runtime/light_field.h"

namespace prt::runtime {

class LightVectors {
 public:
  /// vec4 of a sample of the light. Throws Error (failed) when they do not fit the uniforms.
  explicit LightVectors(std::size_t vector_count);

  gl::Defines defines(bool varies) const;
  /// `pack` writes a sample's coefficients into its vectors, which are 0 before.
  void set(const LightField& field,
           const std::function<void(const sh::Light& sample, Vec4* vectors)>& pack);
  bool varies() const { return vectors_.size() > vector_count_; }
  /// To the program in use: a table takes texture unit 1.
  void bind(const gl::Program& program) const;

 private:
  std::size_t vector_count_;
  std::vector<Vec4> vectors_;  // sample by sample
  gl::Table table_;
  LightGrid grid_;
};

}  // namespace prt::runtime
