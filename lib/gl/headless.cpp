#include <epoxy/egl.h>

#include <array>

#include "core/error.h"
#include "gl/context.h"
#include "gl/debug.h"

namespace prt::gl {

namespace {

// The value of <EGL/eglmesaext.h>, which not every epoxy knows.
constexpr EGLenum kPlatformSurfacelessMesa = 0x31DD;

bool client_has(const char* extension) {
  return epoxy_has_egl_extension(EGL_NO_DISPLAY, extension);
}

EGLDisplay initialized(EGLDisplay display) {
  if (display == EGL_NO_DISPLAY) return EGL_NO_DISPLAY;
  return eglInitialize(display, nullptr, nullptr) ? display : EGL_NO_DISPLAY;
}

EGLDisplay open_display() {
  if (!client_has("EGL_EXT_platform_base")) return initialized(eglGetDisplay(EGL_DEFAULT_DISPLAY));
  EGLDisplay display = EGL_NO_DISPLAY;
  if (client_has("EGL_MESA_platform_surfaceless"))
    display = initialized(
        eglGetPlatformDisplayEXT(kPlatformSurfacelessMesa, EGL_DEFAULT_DISPLAY, nullptr));
  if (display != EGL_NO_DISPLAY || !client_has("EGL_EXT_platform_device") ||
      !client_has("EGL_EXT_device_enumeration"))
    return display;
  std::array<EGLDeviceEXT, 16> devices{};
  EGLint count = 0;
  eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count);
  for (EGLint i = 0; i < count && display == EGL_NO_DISPLAY; ++i)
    display = initialized(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
  return display;
}

EGLContext create_context(EGLDisplay display, const ContextOptions& options) {
  const bool es = options.api == Api::es_3_0;
  if (!eglBindAPI(es ? EGL_OPENGL_ES_API : EGL_OPENGL_API)) return EGL_NO_CONTEXT;
  const EGLint config_attributes[] = {EGL_RENDERABLE_TYPE, es ? EGL_OPENGL_ES3_BIT : EGL_OPENGL_BIT,
                                      EGL_SURFACE_TYPE, 0, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint config_count = 0;
  eglChooseConfig(display, config_attributes, &config, 1, &config_count);
  if (config_count == 0) return EGL_NO_CONTEXT;
  const EGLint debug = options.debug ? EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR : 0;
  const EGLint core[] = {EGL_CONTEXT_MAJOR_VERSION_KHR,
                         3,
                         EGL_CONTEXT_MINOR_VERSION_KHR,
                         3,
                         EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                         EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                         EGL_CONTEXT_FLAGS_KHR,
                         debug,
                         EGL_NONE};
  const EGLint embedded[] = {EGL_CONTEXT_MAJOR_VERSION_KHR,
                             3,
                             EGL_CONTEXT_MINOR_VERSION_KHR,
                             0,
                             EGL_CONTEXT_FLAGS_KHR,
                             debug,
                             EGL_NONE};
  return eglCreateContext(display, config, EGL_NO_CONTEXT, es ? embedded : core);
}

}  // namespace

HeadlessContext::HeadlessContext(const ContextOptions& options) {
  constexpr const char* kAdvice = "Install a driver such as libgl1-mesa-dri and libegl-mesa0.";
  display_ = open_display();
  if (display_ == EGL_NO_DISPLAY)
    throw_failed("EGL offers no display without a window system", {.advice = kAdvice});
  context_ = create_context(display_, options);
  if (context_ == EGL_NO_CONTEXT ||
      !eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
    const bool es = options.api == Api::es_3_0;
    throw_failed("EGL made no context",
                 {.expected = es ? "OpenGL ES 3.0" : "OpenGL 3.3 core", .advice = kAdvice});
  }
  if (options.debug) enable_driver_messages();
}

HeadlessContext::~HeadlessContext() {
  // The display stays initialised: other contexts of the process may share it.
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
  eglReleaseThread();
}

}  // namespace prt::gl
