// The weights of vertices as shaders/weights.glsl reads them: attributes from kFirstWeightLocation
// on, or, when clusters have different numbers of vectors, a table.
#pragma once

#include "cpca/encoding.h"
#include "gl/objects.h"
#include "gl/program.h"

namespace prt::runtime {

constexpr unsigned int kFirstWeightLocation = 2;

class WeightInputs {
 public:
  /// Attribute locations from `end_location` on are used otherwise. Throws Error (failed) when the
  /// components need more.
  WeightInputs(const cpca::Encoding& encoding, unsigned int end_location);

  gl::Defines defines() const;
  void attach(gl::VertexArray& array) const;
  /// To the program in use: a table takes texture unit 1.
  void bind(const gl::Program& program) const;

 private:
  bool is_adaptive_;
  int component_count_;
  gl::Buffer weights_;  // of adaptive encodings, the ranges in the table
  gl::Table table_;
};

}  // namespace prt::runtime
