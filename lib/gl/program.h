// Shader programs from files. Shaders are written in the common subset of GLSL 3.30 and GLSL ES
// 3.00 without a version line: the loader puts the one of the current context, the precision
// defaults and the given #defines on top, and resolves `#include "file"` lines. Compile errors name
// the file and line as written.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"

namespace prt::gl {

/// Where shaders lie: the environment variable PRTKIT_SHADER_DIR; else, seen from the running
/// program, ../share/prtkit/shaders; else the source folder that prtkit was built from.
std::filesystem::path shader_folder();

/// "NAME VALUE", as after #define.
using Defines = std::vector<std::string>;
/// All of them.
Defines joined(std::initializer_list<Defines> parts);

class Program {
 public:
  Program() = default;
  /// File names relative to shader_folder(). `captured`: the output of the vertex shader, an array
  /// as a whole, that a gl::Capture writes. Throws Error (failed) with the compiler's log.
  Program(const std::string& vertex_file, const std::string& fragment_file,
          const Defines& defines = {}, const char* captured = nullptr);
  ~Program();
  Program(Program&& other) noexcept;
  Program& operator=(Program&& other) noexcept;

  void use() const;

  /// Of the program in use. A name that the shader does not use is ignored, as in OpenGL.
  void set(const char* uniform, int value) const;
  void set(const char* uniform, float value) const;
  void set(const char* uniform, const Vec3& value) const;
  void set(const char* uniform, const Vec4& value) const;
  void set(const char* uniform, const Matrix4& value) const;
  void set(const char* uniform, std::span<const Vec4> values) const;
  /// For loops that set one uniform many times.
  int location(const char* uniform) const;

 private:
  unsigned int name_ = 0;
};

}  // namespace prt::gl
