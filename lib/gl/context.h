// OpenGL contexts: headless through EGL, needing neither window system nor GPU, and windows through
// GLFW. Everything drawn uses the common subset of OpenGL 3.3 core and OpenGL ES 3.0, so either
// will do. A context is current on the thread that made it; OpenGL objects must die before it.
#pragma once

#include <string>

struct GLFWwindow;

namespace prt::gl {

enum class Api { core_3_3, es_3_0 };

struct ContextOptions {
  Api api = Api::core_3_3;
  bool debug = false;  ///< log the driver's messages (level debug)
};

/// Surfaceless; without Mesa's surfaceless platform, the first EGL device that works. Throws Error
/// (failed).
class HeadlessContext {
 public:
  explicit HeadlessContext(const ContextOptions& options = {});
  ~HeadlessContext();
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
};

/// A window with an 8-bit colour buffer and no depth. Throws Error (failed) without a display.
class Window {
 public:
  Window(const std::string& title, int width, int height, const ContextOptions& options = {});
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  GLFWwindow* handle() const { return window_; }
  /// In pixels, which can differ from screen coordinates.
  struct Size {
    int width, height;
  };
  Size framebuffer_size() const;

 private:
  GLFWwindow* window_ = nullptr;
};

/// Of the current context, queried from the driver.
struct Limits {
  int max_texture_size;
  int max_vertex_attributes;       ///< vec4 each
  int max_vertex_uniform_vectors;  ///< vec4 each
  int max_varying_vectors;         ///< vec4 each, from vertices to pixels
  int max_captured_vectors;        ///< vec4 each, from vertices to buffers (gl::Capture)
  bool float32_targets;            ///< RGBA32F can be drawn to and blended
  bool float32_filters;            ///< RGBA32F can be filtered
  bool unorm16_textures;           ///< normalised integers of 16 bits can be textures
  int max_samples;                 ///< of the colour format that targets use
  bool sample_textures;            ///< shaders can read the samples of a target one by one
};
Limits limits();

/// "4.5 (Core Profile) Mesa 22.3.6, llvmpipe (…)".
std::string description();

/// Returns when all that was asked for is done.
void finish();

/// Throws Error (failed) when OpenGL has recorded an error: "OpenGL: out of memory while …".
void check_errors(const std::string& doing);

}  // namespace prt::gl
