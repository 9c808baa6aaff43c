#include "gl/context.h"

#include <epoxy/gl.h>

#include <algorithm>

#include "core/error.h"
#include "core/log.h"
#include "gl/debug.h"

namespace prt::gl {

namespace {

int integer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

const char* error_name(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "invalid enumeration";
    case GL_INVALID_VALUE:
      return "invalid value";
    case GL_INVALID_OPERATION:
      return "invalid operation";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "incomplete framebuffer";
    case GL_OUT_OF_MEMORY:
      return "out of memory";
    default:
      return "unknown error";
  }
}

void log_driver_message(GLenum, GLenum, GLuint, GLenum, GLsizei, const GLchar* message,
                        const void*) {
  log::debug("OpenGL: {}", message);
}

int max_samples_of(GLenum format) {
  const bool can_ask = !epoxy_is_desktop_gl() || epoxy_gl_version() >= 42 ||
                       epoxy_has_gl_extension("GL_ARB_internalformat_query");
  if (!can_ask) return integer(GL_MAX_SAMPLES);
  GLint samples = 1;  // stays 1 when the format has no multisampling
  glGetInternalformativ(GL_RENDERBUFFER, format, GL_SAMPLES, 1, &samples);
  return samples;
}

}  // namespace

void enable_driver_messages() {
  if (!epoxy_has_gl_extension("GL_KHR_debug")) return;
  glEnable(GL_DEBUG_OUTPUT);
  glDebugMessageCallback(log_driver_message, nullptr);
}

Limits limits() {
  Limits limits;
  limits.max_texture_size = integer(GL_MAX_TEXTURE_SIZE);
  limits.max_vertex_attributes = integer(GL_MAX_VERTEX_ATTRIBS);
  limits.float32_targets =
      epoxy_is_desktop_gl() || (epoxy_has_gl_extension("GL_EXT_color_buffer_float") &&
                                epoxy_has_gl_extension("GL_EXT_float_blend"));
  limits.max_vertex_uniform_vectors = epoxy_is_desktop_gl()
                                          ? integer(GL_MAX_VERTEX_UNIFORM_COMPONENTS) / 4
                                          : integer(GL_MAX_VERTEX_UNIFORM_VECTORS);
  // gl_Position is among the outputs.
  const int varying_components =
      std::min({integer(GL_MAX_VARYING_COMPONENTS), integer(GL_MAX_VERTEX_OUTPUT_COMPONENTS) - 4,
                integer(GL_MAX_FRAGMENT_INPUT_COMPONENTS)});
  limits.max_varying_vectors = varying_components / 4;
  limits.max_captured_vectors = integer(GL_MAX_TRANSFORM_FEEDBACK_INTERLEAVED_COMPONENTS) / 4;
  limits.float32_filters =
      epoxy_is_desktop_gl() || epoxy_has_gl_extension("GL_OES_texture_float_linear");
  limits.unorm16_textures =
      epoxy_is_desktop_gl() || epoxy_has_gl_extension("GL_EXT_texture_norm16");
  limits.max_samples = max_samples_of(limits.float32_targets ? GL_RGBA32F : GL_RGBA16F);
  limits.sample_textures = epoxy_is_desktop_gl();
  return limits;
}

std::string description() {
  const auto text = [](GLenum name) {
    return std::string(reinterpret_cast<const char*>(glGetString(name)));
  };
  return text(GL_VERSION) + ", " + text(GL_RENDERER);
}

void finish() { glFinish(); }

void check_errors(const std::string& doing) {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  while (glGetError() != GL_NO_ERROR) {
  }
  throw_failed(std::string("OpenGL: ") + error_name(error) + " while " + doing);
}

}  // namespace prt::gl
