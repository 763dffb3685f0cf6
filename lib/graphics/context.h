// SPDX-License-Identifier: Apache-2.0
#pragma once
// A place to draw without a window, a screen or an X server. No messages.

#include <memory>

#include <hc/base/result.h>

namespace hc::graphics {

/// An OpenGL 3.3 core context over EGL, without a surface: what is drawn goes into buffers of one's
/// own. It is current on the thread that has made it, where it has to be used and destroyed.
class Context {
 public:
  /// Errors: Unsupported (no EGL without a surface, or no OpenGL 3.3, with what EGL says).
  /// Cost: 10 to 100 ms.
  static Result<std::unique_ptr<Context>> make();

  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

 private:
  Context(void* display, void* context) : display_(display), context_(context) {}

  void* display_;  // EGLDisplay
  void* context_;  // EGLContext
};

}  // namespace hc::graphics
