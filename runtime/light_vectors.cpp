#include "runtime/light_vectors.h"

#include <fmt/format.h>

#include "core/error.h"
#include "runtime/exit_stage.h"

namespace prt::runtime {

namespace {

constexpr int kLightUnit = 1;

}  // namespace

LightVectors::LightVectors(std::size_t vector_count)
    : vector_count_(vector_count), vectors_(vector_count, Vec4(0.0f)) {
  const auto most = static_cast<std::size_t>(free_uniform_vectors(gl::limits()));
  if (vector_count > most)
    throw_failed("this OpenGL has too few uniforms to draw uncompressed transfer",
                 {.found = fmt::format("{} vectors of light", vector_count),
                  .expected = fmt::format("at most {}", most)});
}

gl::Defines LightVectors::defines(bool varies) const {
  gl::Defines defines = light_field_defines(varies);
  defines.push_back(fmt::format("LIGHT_VECTOR_COUNT {}", vector_count_));
  return defines;
}

void LightVectors::set(const LightField& field,
                       const std::function<void(const sh::Light&, Vec4*)>& pack) {
  grid_ = field.grid;
  vectors_.assign(field.samples.size() * vector_count_, Vec4(0.0f));
  for (std::size_t i = 0; i < field.samples.size(); ++i)
    pack(field.samples[i], &vectors_[i * vector_count_]);
  if (!varies()) return;
  table_ = gl::Table(vectors_.size());
  table_.upload(vectors_);
}

void LightVectors::bind(const gl::Program& program) const {
  if (!varies()) return program.set("u_light", vectors_);
  grid_.bind(program);
  program.set("u_lights", kLightUnit);
  table_.bind(kLightUnit);
}

}  // namespace prt::runtime
