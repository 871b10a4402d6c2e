#include "egl_context.h"

#include <array>
#include <vector>

#include <EGL/eglext.h>
#include <GL/gl.h>

#include <tether/base/error.h>

namespace tether::sim {
namespace {

template <class Function>
Function egl_function(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

// The displays to try, in order: the devices (GPUs come before software), then Mesa without a
// device.
std::vector<EGLDisplay> headless_displays() {
  std::vector<EGLDisplay> displays;
  const auto get_display =
      egl_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (!get_display) return displays;
  if (const auto query = egl_function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT")) {
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    if (!query(static_cast<EGLint>(devices.size()), devices.data(), &count)) count = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      displays.push_back(get_display(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
    }
  }
  displays.push_back(get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  return displays;
}

}  // namespace

EglContext::EglContext() {
  for (EGLDisplay display : headless_displays()) {
    if (display != EGL_NO_DISPLAY && open(display)) return;
  }
  throw Error(ErrorCode::kSetup,
              "no OpenGL for camera images; install libegl1 and libgl1-mesa-dri (software) or the "
              "GPU's driver, or free memory if they are installed");
}

EglContext::~EglContext() {
  if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
}

bool EglContext::open(EGLDisplay display) {
  if (!eglInitialize(display, nullptr, nullptr)) return false;
  if (!eglBindAPI(EGL_OPENGL_API)) return false;
  const std::array<EGLint, 5> attributes{EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                         EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglChooseConfig(display, attributes.data(), &config, 1, &count) || count == 0) return false;
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr);
  if (context == EGL_NO_CONTEXT) return false;
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    eglDestroyContext(display, context);
    return false;
  }
  display_ = display;
  context_ = context;
  renderer_name_ = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  release();
  return true;
}

void EglContext::bind() {
  eglBindAPI(EGL_OPENGL_API);
  if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
    throw Error(ErrorCode::kSetup, "the OpenGL context for camera images is lost or in use");
  }
}

void EglContext::release() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

}  // namespace tether::sim
