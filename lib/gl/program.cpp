#include "gl/program.h"

#include <epoxy/gl.h>

#include <utility>

#include "core/error.h"
#include "gl/shader_source.h"

namespace prt::gl {

namespace {

unsigned int compile(GLenum stage, const std::string& file, const Defines& defines) {
  const ShaderSource source = load_shader_source(file, defines, !epoxy_is_desktop_gl());
  const GLuint shader = glCreateShader(stage);
  const char* text = source.text.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint compiled = 0, log_length = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled) return shader;
  glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &log_length);
  std::string log(static_cast<std::size_t>(log_length), '\0');
  glGetShaderInfoLog(shader, log_length, &log_length, log.data());
  log.resize(static_cast<std::size_t>(log_length));
  glDeleteShader(shader);
  throw_failed("a shader does not compile:\n" + with_file_names(log, source.files),
               {.file = source.files.front().string()});
}

}  // namespace

Defines joined(std::initializer_list<Defines> parts) {
  Defines all;
  for (const Defines& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

Program::Program(const std::string& vertex_file, const std::string& fragment_file,
                 const Defines& defines, const char* captured)
    : name_(glCreateProgram()) {
  for (const auto& [stage, file] :
       {std::pair<GLenum, const std::string&>(GL_VERTEX_SHADER, vertex_file),
        {GL_FRAGMENT_SHADER, fragment_file}}) {
    const unsigned int shader = compile(stage, file, defines);
    glAttachShader(name_, shader);
    glDeleteShader(shader);  // lives on in the program
  }
  if (captured) glTransformFeedbackVaryings(name_, 1, &captured, GL_INTERLEAVED_ATTRIBS);
  glLinkProgram(name_);
  GLint linked = 0, log_length = 0;
  glGetProgramiv(name_, GL_LINK_STATUS, &linked);
  if (linked) return;
  glGetProgramiv(name_, GL_INFO_LOG_LENGTH, &log_length);
  std::string log(static_cast<std::size_t>(log_length), '\0');
  glGetProgramInfoLog(name_, log_length, &log_length, log.data());
  log.resize(static_cast<std::size_t>(log_length));
  glDeleteProgram(name_);
  throw_failed("shaders " + vertex_file + " and " + fragment_file + " do not link:\n" + log);
}

Program::~Program() {
  if (name_ != 0) glDeleteProgram(name_);
}

Program::Program(Program&& other) noexcept : name_(std::exchange(other.name_, 0)) {}

Program& Program::operator=(Program&& other) noexcept {
  std::swap(name_, other.name_);
  return *this;
}

void Program::use() const { glUseProgram(name_); }

int Program::location(const char* uniform) const { return glGetUniformLocation(name_, uniform); }

void Program::set(const char* uniform, int value) const { glUniform1i(location(uniform), value); }
void Program::set(const char* uniform, float value) const { glUniform1f(location(uniform), value); }
void Program::set(const char* uniform, const Vec3& value) const {
  glUniform3fv(location(uniform), 1, &value.x);
}
void Program::set(const char* uniform, const Vec4& value) const {
  glUniform4fv(location(uniform), 1, &value.x);
}
void Program::set(const char* uniform, const Matrix4& value) const {
  glUniformMatrix4fv(location(uniform), 1, GL_FALSE, value.getValue());
}
void Program::set(const char* uniform, std::span<const Vec4> values) const {
  glUniform4fv(location(uniform), static_cast<GLsizei>(values.size()), &values.front().x);
}

}  // namespace prt::gl
