#pragma once

#include <string>

#include <EGL/egl.h>

namespace tether::sim {

/// A headless OpenGL context: on the first suitable GPU, else in software. Needs no display.
class EglContext {
 public:
  /// @throws Error(kSetup) without OpenGL.
  EglContext();
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  /// Makes it the calling thread's context. @throws Error(kSetup)
  void bind();
  /// So that another thread may bind it.
  void release();

  /// OpenGL's name of the renderer.
  const std::string& renderer_name() const { return renderer_name_; }

 private:
  bool open(EGLDisplay display);

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  std::string renderer_name_;
};

/// Binds a context for the length of a scope.
class EglBinding {
 public:
  explicit EglBinding(EglContext& context) : context_(context) { context_.bind(); }
  ~EglBinding() { context_.release(); }
  EglBinding(const EglBinding&) = delete;
  EglBinding& operator=(const EglBinding&) = delete;

 private:
  EglContext& context_;
};

}  // namespace tether::sim
