// What every way of drawing has in common after it knows a vertex's exit values: the shaders'
// send_exit.glsl and fragment shader, with the frames and the functions that glossy transfer needs
// [Sloan03] §6.2.
#pragma once

#include "gl/context.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "runtime/draw_calls.h"
#include "runtime/exit_layout.h"
#include "runtime/model.h"
#include "runtime/view_basis.h"

namespace prt::runtime {

/// Passes that glossy transfer is drawn in: as few as the context can, all colours in one, or one
/// for each colour. Diffuse transfer always takes one.
enum class Passes { automatic, one, per_channel };

/// How transfer is drawn: the first two of glossy transfer. Passes and sums leave the pixels as
/// they are; a map errs by 0.001.
struct ExitOptions {
  Passes passes = Passes::automatic;
  ViewBasis view_basis = ViewBasis::polynomial;
  bool keep_sums = true;  ///< false: all drawing will be Sums::every_frame, nothing is made to keep
};

/// 1 or 3. A pass needs its vec4 of exit values and the view as varyings, and of a cluster's
/// constants, `vector_count` + 1 (0: not compressed), those vec4 as uniforms. Throws Error (failed)
/// when the context has too few.
int choose_pass_count(Passes passes, int row_count, int vector_count, const gl::Limits& limits);

/// vec4 uniforms of a vertex shader that are left for constants or light.
int free_uniform_vectors(const gl::Limits& limits);

class ExitStage {
 public:
  /// Attributes from here on are the stage's own.
  static constexpr unsigned int kFirstLocation = 14;

  /// Throws Error (failed), see choose_pass_count.
  ExitStage(const Model& model, const ExitOptions& options);

  const ExitLayout& layout() const { return layout_; }
  /// Attribute locations below this are free.
  unsigned int end_location() const;
  gl::Defines defines() const;
  /// For programs that capture the exit values of one colour at a time (runtime/exit_buffer.h).
  gl::Defines capture_defines() const;
  const char* fragment_shader() const;
  void attach(gl::VertexArray& array) const;
  /// Uniforms and textures (unit 2) of the program, which is in use.
  void bind(const gl::Program& program, const Viewpoint& viewpoint) const;

 private:
  ExitLayout layout_;
  gl::Buffer normals_, tangents_;
  ViewBasis view_basis_;
  gl::TextureArray functions_;  // of a map
};

}  // namespace prt::runtime
