#include <epoxy/gl.h>
// GLFW comes after epoxy, which stands in for the system's OpenGL header.
#include <GLFW/glfw3.h>

#include "core/error.h"
#include "gl/context.h"
#include "gl/debug.h"

namespace prt::gl {

namespace {

[[noreturn]] void throw_glfw_error(const char* what) {
  const char* reason = nullptr;
  glfwGetError(&reason);
  throw_failed(std::string(what) + (reason ? std::string(": ") + reason : std::string()),
               {.advice = "Run on a desktop, or under xvfb-run."});
}

}  // namespace

Window::Window(const std::string& title, int width, int height, const ContextOptions& options) {
  if (!glfwInit()) throw_glfw_error("cannot reach the window system");
  const bool es = options.api == Api::es_3_0;
  glfwWindowHint(GLFW_CLIENT_API, es ? GLFW_OPENGL_ES_API : GLFW_OPENGL_API);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, es ? 0 : 3);
  if (!es) glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, options.debug);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (!window_) {
    glfwTerminate();
    throw_glfw_error("cannot open a window");
  }
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  if (options.debug) enable_driver_messages();
}

Window::~Window() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

Window::Size Window::framebuffer_size() const {
  Size size{};
  glfwGetFramebufferSize(window_, &size.width, &size.height);
  return size;
}

}  // namespace prt::gl
