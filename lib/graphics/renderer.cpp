// SPDX-License-Identifier: Apache-2.0
#define GL_GLEXT_PROTOTYPES
#include <graphics/renderer.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/format.h>
#include <opencv2/imgproc.hpp>

namespace hc::graphics {
namespace {

constexpr const char* kVertexShader = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 texture_place;
layout(location = 3) in vec3 factor;
uniform mat4 projection;      // of a camera's frame
uniform mat4 T_camera_object;
uniform vec3 to_light;        // camera's frame
uniform float ambient, diffuse;
out vec2 place;
out vec3 brightness;
void main() {
  gl_Position = projection * (T_camera_object * vec4(position, 1.0));
  place = texture_place;
  brightness = factor * (ambient + diffuse *
      max(dot(normalize(mat3(T_camera_object) * normal), to_light), 0.0));
}
)";

constexpr const char* kFragmentShader = R"(#version 330 core
in vec2 place;
in vec3 brightness;
uniform sampler2D image;
layout(location = 0) out vec4 colour;
void main() { colour = vec4(texture(image, place).rgb * brightness, 1.0); }
)";

Error failure(const char* call) {
  return Error{Code::Unsupported, hc::format("graphics: {} failed with 0x{:04x}", call,
                                             static_cast<unsigned>(eglGetError()))};
}

/// An OpenGL 3.3 core context over EGL, for drawing into buffers without a window, screen or X
/// server. Current on the thread that made it.
class Context {
 public:
  /// Errors: Unsupported (no surfaceless EGL, or no OpenGL 3.3; with EGL's error).
  /// Cost: 10 to 100 ms.
  static Result<std::unique_ptr<Context>> make() {
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
  ~Context() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
  }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

 private:
  Context(EGLDisplay display, EGLContext context) : display_(display), context_(context) {}

  EGLDisplay display_;
  EGLContext context_;
};

/// The result of compiling a shader or linking a program.
///
/// @param what  GL_COMPILE_STATUS or GL_LINK_STATUS. @param get, get_log  glGetShaderiv and
/// glGetShaderInfoLog, or those of programs. Errors: Unsupported (with the compiler's log).
template <typename Get, typename GetLog>
Status outcome(GLuint object, GLenum what, Get get, GetLog get_log) {
  GLint done = 0;
  get(object, what, &done);
  if (done != 0) return {};
  char log[256] = "";
  get_log(object, sizeof log, nullptr, log);
  return Error{Code::Unsupported, std::string("graphics: shader: ") + log};
}

Result<GLuint> link_program() {
  const GLuint program = glCreateProgram();
  for (auto [kind, source] : {std::pair{GLenum{GL_VERTEX_SHADER}, kVertexShader},
                              {GLenum{GL_FRAGMENT_SHADER}, kFragmentShader}}) {
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    HC_TRY(outcome(shader, GL_COMPILE_STATUS, glGetShaderiv, glGetShaderInfoLog));
    glAttachShader(program, shader);
    glDeleteShader(shader);
  }
  glLinkProgram(program);
  HC_TRY(outcome(program, GL_LINK_STATUS, glGetProgramiv, glGetProgramInfoLog));
  return program;
}

/// From a camera's frame to OpenGL's clip space. Rows are read from the top down, since OpenGL's
/// first row is at clip coordinate -1.
Eigen::Matrix4f projection(const PinholeCamera& camera) {
  const double w = camera.width, h = camera.height, n = camera.near, f = camera.far;
  Eigen::Matrix4d matrix;
  matrix << 2 * camera.fx / w, 0, 2 * (camera.cx + 0.5) / w - 1, 0,  //
      0, 2 * camera.fy / h, 2 * (camera.cy + 0.5) / h - 1, 0,        //
      0, 0, (f + n) / (f - n), -2 * f * n / (f - n),                 //
      0, 0, 1, 0;
  return matrix.cast<float>();
}

/// Makes and binds a buffer with elements.
template <typename T>
GLuint upload(GLenum kind, const std::vector<T>& elements) {
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(kind, buffer);
  glBufferData(kind, static_cast<GLsizeiptr>(elements.size() * sizeof(T)), elements.data(),
               GL_STATIC_DRAW);
  return buffer;
}

struct Surface {
  GLuint vertices = 0, corners = 0, indices = 0, texture = 0;
  GLsizei count = 0;
};

/// The framebuffer, as large as the largest image so far.
struct Target {
  int width = 0, height = 0;
  GLuint frame = 0, colour = 0, depth = 0;
};

}  // namespace

struct Renderer::State {
  std::unique_ptr<Context> context;
  GLuint program = 0;
  GLint projection = 0, T_camera_object = 0, to_light = 0, ambient = 0, diffuse = 0;
  std::vector<Surface> surfaces;
  std::vector<SurfaceId> removed;  // numbers for the next ones
  Target target;
  cv::Mat rgba, raw_depth;

  Status aim(int width, int height);
};

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
// The context frees OpenGL's objects.
Renderer::~Renderer() = default;

Result<std::unique_ptr<Renderer>> Renderer::make() {
  auto context = HC_TRY(Context::make());
  auto state = std::make_unique<State>();
  state->context = std::move(context);
  auto program = HC_TRY(link_program());
  state->program = program;
  glUseProgram(program);
  auto place = [&](const char* name) { return glGetUniformLocation(state->program, name); };
  state->projection = place("projection");
  state->T_camera_object = place("T_camera_object");
  state->to_light = place("to_light");
  state->ambient = place("ambient");
  state->diffuse = place("diffuse");
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_SCISSOR_TEST);  // limits glClear() to the drawn part
  glEnable(GL_CULL_FACE);
  glFrontFace(GL_CW);  // since y is flipped
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  return std::unique_ptr<Renderer>(new Renderer(std::move(state)));
}

SurfaceId Renderer::add(const Mesh& mesh, const cv::Mat& texture) {
  static_assert(sizeof(Vertex) == 11 * sizeof(float));
  Surface surface;
  surface.count = static_cast<GLsizei>(mesh.indices.size());
  glGenVertexArrays(1, &surface.vertices);
  glBindVertexArray(surface.vertices);
  surface.corners = upload(GL_ARRAY_BUFFER, mesh.vertices);
  surface.indices = upload(GL_ELEMENT_ARRAY_BUFFER, mesh.indices);
  const std::pair<GLint, std::size_t> attributes[] = {{3, offsetof(Vertex, position)},
                                                      {3, offsetof(Vertex, normal)},
                                                      {2, offsetof(Vertex, texture)},
                                                      {3, offsetof(Vertex, colour)}};
  GLuint number = 0;
  for (auto [size, offset] : attributes) {
    glEnableVertexAttribArray(number);
    // OpenGL takes an offset for a pointer. NOLINTNEXTLINE(performance-no-int-to-ptr)
    const auto* place = reinterpret_cast<const void*>(offset);
    glVertexAttribPointer(number++, size, GL_FLOAT, GL_FALSE, sizeof(Vertex), place);
  }
  glGenTextures(1, &surface.texture);
  SurfaceId id = state_->surfaces.size();
  if (state_->removed.empty()) {
    state_->surfaces.push_back(surface);
  } else {
    id = state_->removed.back();
    state_->removed.pop_back();
    state_->surfaces[id] = surface;
  }
  set_texture(id, texture);
  return id;
}

void Renderer::remove(SurfaceId surface) {
  Surface& freed = state_->surfaces.at(surface);
  HC_CHECK(freed.vertices != 0, surface);
  glDeleteVertexArrays(1, &freed.vertices);
  glDeleteBuffers(1, &freed.corners);
  glDeleteBuffers(1, &freed.indices);
  glDeleteTextures(1, &freed.texture);
  freed = {};
  state_->removed.push_back(surface);
}

void Renderer::set_texture(SurfaceId surface, const cv::Mat& texture) {
  const cv::Mat packed = texture.isContinuous() ? texture : texture.clone();
  glBindTexture(GL_TEXTURE_2D, state_->surfaces.at(surface).texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, packed.cols, packed.rows, 0, GL_RGB, GL_UNSIGNED_BYTE,
               packed.data);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glGenerateMipmap(GL_TEXTURE_2D);
}

Status Renderer::State::aim(int width, int height) {
  glViewport(0, 0, width, height);
  glScissor(0, 0, width, height);
  if (width <= target.width && height <= target.height && width > 0 && height > 0) return {};
  GLint most = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
  if (width < 1 || height < 1 || width > most || height > most)
    return Error{Code::Unsupported, "graphics: an image of " + std::to_string(width) + " x " +
                                        std::to_string(height) + " cannot be drawn, " +
                                        std::to_string(most) + " is the maximum"};
  width = std::max(width, target.width);
  height = std::max(height, target.height);
  if (target.frame == 0) {
    glGenFramebuffers(1, &target.frame);
    glGenRenderbuffers(1, &target.colour);
    glGenRenderbuffers(1, &target.depth);
    glBindFramebuffer(GL_FRAMEBUFFER, target.frame);
  }
  glBindRenderbuffer(GL_RENDERBUFFER, target.colour);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target.colour);
  glBindRenderbuffer(GL_RENDERBUFFER, target.depth);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, target.depth);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    return Error{Code::Unsupported, "graphics: OpenGL cannot draw into memory here"};
  target.width = width;
  target.height = height;
  return {};
}

Status Renderer::render(std::span<const Item> items, const PinholeCamera& camera,
                        const Eigen::Isometry3d& T_world_camera, const Light& light) {
  HC_TRY(state_->aim(camera.width, camera.height));
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  const Eigen::Isometry3f T_camera_world = T_world_camera.inverse().cast<float>();
  glUniformMatrix4fv(state_->projection, 1, GL_FALSE, projection(camera).eval().data());
  const Eigen::Vector3f to_light = T_camera_world.linear() * light.to_light.normalized();
  glUniform3fv(state_->to_light, 1, to_light.data());
  glUniform1f(state_->ambient, light.ambient * light.exposure);
  glUniform1f(state_->diffuse, light.diffuse * light.exposure);
  // The last first: small items hide parts of the walls, which then need no shading.
  for (std::size_t i = items.size(); i-- > 0;) {
    const Item& item = items[i];
    const Surface& surface = state_->surfaces.at(item.surface);
    const Eigen::Matrix4f T_camera_object =
        (T_camera_world * item.T_world_object * Eigen::Scaling(item.scale)).matrix();
    glUniformMatrix4fv(state_->T_camera_object, 1, GL_FALSE, T_camera_object.data());
    glBindTexture(GL_TEXTURE_2D, surface.texture);
    glBindVertexArray(surface.vertices);
    glDrawElements(GL_TRIANGLES, surface.count, GL_UNSIGNED_INT, nullptr);
  }
  return {};
}

void Renderer::read_depth(const PinholeCamera& camera, cv::Mat& depth) {
  depth.create(camera.height, camera.width, CV_32F);
  state_->raw_depth.create(camera.height, camera.width, CV_32F);
  glReadPixels(0, 0, camera.width, camera.height, GL_DEPTH_COMPONENT, GL_FLOAT,
               state_->raw_depth.data);
  // Inverts d = (1 + clip z / clip w) / 2.
  const auto near = static_cast<float>(camera.near), far = static_cast<float>(camera.far);
  for (int row = 0; row < camera.height; ++row) {
    const auto* from = state_->raw_depth.ptr<float>(row);
    auto* to = depth.ptr<float>(row);
    for (int column = 0; column < camera.width; ++column)
      to[column] = from[column] >= 1 ? 0 : near * far / (far - from[column] * (far - near));
  }
}

Status Renderer::draw(std::span<const Item> items, const PinholeCamera& camera,
                      const Eigen::Isometry3d& T_world_camera, const Light& light, cv::Mat& rgb,
                      cv::Mat* depth) {
  HC_TRY(render(items, camera, T_world_camera, light));
  state_->rgba.create(camera.height, camera.width, CV_8UC4);
  glReadPixels(0, 0, camera.width, camera.height, GL_RGBA, GL_UNSIGNED_BYTE, state_->rgba.data);
  cv::cvtColor(state_->rgba, rgb, cv::COLOR_RGBA2RGB);
  if (depth != nullptr) read_depth(camera, *depth);
  return {};
}

Status Renderer::draw_part(std::span<const Item> items, const PinholeCamera& camera,
                           const cv::Rect& part, const Eigen::Isometry3d& T_world_camera,
                           const Light& light, cv::Mat& rgba, cv::Mat& depth) {
  PinholeCamera window = camera;
  window.width = part.width;
  window.height = part.height;
  window.cx -= part.x;
  window.cy -= part.y;
  HC_TRY(render(items, window, T_world_camera, light));
  rgba.create(part.size(), CV_8UC4);
  glReadPixels(0, 0, part.width, part.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data);
  read_depth(window, depth);
  return {};
}

}  // namespace hc::graphics
