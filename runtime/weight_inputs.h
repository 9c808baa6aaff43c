// The weights of vertices as shaders/weights.glsl reads them: attributes from kFirstWeightLocation
// on, or, when clusters have different numbers of vectors, a table. OpenGL has them in the format
// of the file, half floats and normalised integers too, which vertices fetch as floats.
#pragma once

#include "cpca/encoding.h"
#include "cpca/weight_format.h"
#include "gl/objects.h"
#include "gl/program.h"

namespace prt::runtime {

constexpr unsigned int kConstantsLocation = 1;  ///< where those of the vertex's cluster begin
constexpr unsigned int kFirstWeightLocation = 2;

class WeightInputs {
 public:
  /// Attribute locations from `end_location` on are used otherwise. Throws Error (failed) when the
  /// components need more.
  WeightInputs(const cpca::Encoding& encoding, cpca::WeightFormat format,
               unsigned int end_location);

  gl::Defines defines() const;
  void attach(gl::VertexArray& array) const;
  /// To the program in use: a table takes texture unit 1.
  void bind(const gl::Program& program) const;

 private:
  bool is_adaptive_;
  int component_count_;
  std::size_t scalar_bytes_;
  gl::Scalar scalar_;
  gl::Buffer weights_;  // of adaptive encodings, the ranges in the table
  gl::Table table_;
};

}  // namespace prt::runtime
