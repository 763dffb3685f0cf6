// SPDX-License-Identifier: Apache-2.0
#include <graphics/context.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <cstdio>
#include <string>

namespace hc::graphics {
namespace {

Error failure(const char* call) {
  char number[16];
  std::snprintf(number, sizeof number, "0x%04x", static_cast<unsigned>(eglGetError()));
  return Error{Code::Unsupported, std::string("graphics: ") + call + " failed with " + number};
}

}  // namespace

Result<std::unique_ptr<Context>> Context::make() {
  EGLDisplay display =
      eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY) return failure("eglGetPlatformDisplay");
  if (eglInitialize(display, nullptr, nullptr) == EGL_FALSE) return failure("eglInitialize");
  if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) return failure("eglBindAPI");
  const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                           3,
                           EGL_CONTEXT_MINOR_VERSION,
                           3,
                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                           EGL_NONE};
  EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
  if (context == EGL_NO_CONTEXT) return failure("eglCreateContext");
  std::unique_ptr<Context> made(new Context(display, context));
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_FALSE)
    return failure("eglMakeCurrent");
  return made;
}

Context::~Context() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
}

}  // namespace hc::graphics
