#include "runtime/exit_stage.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "runtime/hemisphere_map.h"

namespace prt::runtime {

namespace {

constexpr int kFunctionsUnit = 2;

ExitLayout make_layout(const Model& model, Passes passes) {
  const int vectors = model.transfer ? model.transfer->encoding.component_count : 0;
  const int rows = model.row_count();
  return exit_layout(rows, choose_pass_count(passes, rows, vectors, gl::limits()));
}

}  // namespace

int free_uniform_vectors(const gl::Limits& limits) {
  constexpr int kOtherUniforms = 12;  // of the shaders
  return std::max(limits.max_vertex_uniform_vectors - kOtherUniforms, 0);
}

int choose_pass_count(Passes passes, int row_count, int vector_count, const gl::Limits& limits) {
  if (row_count == 1) return 1;
  const auto fits = [&](int pass_count) {
    const auto vectors = static_cast<int>(exit_layout(row_count, pass_count).pass_vector_count());
    return vectors + 1 <= limits.max_varying_vectors &&
           (vector_count + 1) * vectors <= free_uniform_vectors(limits);
  };
  if (passes == Passes::one ? fits(1) : passes == Passes::automatic && fits(1)) return 1;
  if (passes != Passes::one && fits(3)) return 3;
  throw_failed(passes == Passes::one
                   ? "this OpenGL cannot draw all colours of the glossy transfer in one pass"
                   : "this OpenGL has too few varyings or uniforms for the glossy transfer",
               {.found = fmt::format("{} exit rows, {} components", row_count, vector_count),
                .advice = passes == Passes::one ? "Let it choose the passes."
                                                : "Bake fewer rows or compress with fewer "
                                                  "components."});
}

ExitStage::ExitStage(const Model& model, const ExitOptions& options)
    : layout_(make_layout(model, options.passes)), view_basis_(options.view_basis) {
  if (!layout_.is_glossy()) return;
  normals_ = gl::Buffer(std::span(model.normals));
  tangents_ = gl::Buffer(std::span(model.tangents));
  if (view_basis_ == ViewBasis::map)
    functions_ = gl::TextureArray(kHemisphereMapSize, hemisphere_map(layout_));
}

unsigned int ExitStage::end_location() const {
  return layout_.is_glossy() ? kFirstLocation
                             : static_cast<unsigned int>(gl::limits().max_vertex_attributes);
}

gl::Defines ExitStage::defines() const {
  gl::Defines defines{fmt::format("VECTOR_COUNT {}", layout_.pass_vector_count()),
                      fmt::format("PASS_COLOR_COUNT {}", layout_.pass_color_count()),
                      fmt::format("COLOR_VECTOR_COUNT {}", layout_.color_vector_count()),
                      fmt::format("CONSTANT_STRIDE {}", layout_.pass_vector_count())};
  if (!layout_.is_glossy()) return defines;
  std::string vectors;
  for (std::size_t i = 0; i < layout_.color_vector_count(); ++i)
    vectors += fmt::format("F({}, {}, {}) ", i, layout_.order_of_pair[2 * i],
                           layout_.order_of_pair[2 * i + 1]);
  defines.insert(defines.end(), {"GLOSSY 1", fmt::format("BAND_COUNT {}", layout_.band_count),
                                 "FOR_EACH_VECTOR(F) " + vectors});
  if (view_basis_ == ViewBasis::polynomial)
    defines.push_back("FOR_EACH_FUNCTIONS(F) " + basis_polynomials(layout_));
  return defines;
}

gl::Defines ExitStage::capture_defines() const {
  return {"CAPTURE 1", fmt::format("VECTOR_COUNT {}", layout_.color_vector_count()),
          "PASS_COLOR_COUNT 1", fmt::format("COLOR_VECTOR_COUNT {}", layout_.color_vector_count()),
          fmt::format("CONSTANT_STRIDE {}", layout_.pass_vector_count())};
}

const char* ExitStage::fragment_shader() const {
  return layout_.is_glossy() ? "exit_radiance.frag" : "radiance.frag";
}

void ExitStage::attach(gl::VertexArray& array) const {
  if (!layout_.is_glossy()) return;
  array.set_floats(kFirstLocation, normals_, 3, sizeof(Vec3), 0);
  array.set_floats(kFirstLocation + 1, tangents_, 4, sizeof(Vec4), 0);
}

void ExitStage::bind(const gl::Program& program, const Viewpoint& viewpoint) const {
  program.set("u_clip_from_world", viewpoint.clip_from_world);
  if (!layout_.is_glossy()) return;
  program.set("u_eye", viewpoint.eye);
  program.set("u_right", viewpoint.right);
  program.set("u_backward", viewpoint.backward);
  if (view_basis_ != ViewBasis::map) return;
  program.set("u_functions", kFunctionsUnit);
  functions_.bind(kFunctionsUnit);
}

}  // namespace prt::runtime
